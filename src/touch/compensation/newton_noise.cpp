// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/newton_noise.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "dermis/touch/frames/random.hpp"
#include "touch/compensation/dense_inverse.hpp"
#include "touch/compensation/matrix_product.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr std::size_t kMostInvertedTaxels = 400;
constexpr int kNoiseSamples = 12;
constexpr std::uint64_t kNoiseSeed = 1;
constexpr double kAccuracy = 1e-2;  // of the solution of a sample's equations

double random_sign(Random& random) noexcept {
  return random.below(2) == 0 ? 1.0 : -1.0;
}

/// The effect of an ohm of its driver on a taxel that is pressed alone: its calibration has learned that with its law.
double alone(const ScaledCircuit& circuit, const NewtonEquations& equations, std::size_t taxel) noexcept {
  return circuit.siemens()[taxel] * circuit.siemens()[taxel] / equations.column_scale()[taxel];
}

/// By the inverse of the equations, which takes rows^3 cols^3 multiplications.
class ExactNoise final : public NewtonNoise {
 public:
  ExactNoise(ScaledCircuit& circuit, NewtonEquations& equations, const DriverErrors& errors)
      : circuit_(circuit),
        equations_(equations),
        errors_(errors),
        inverse_(circuit.x().size()),
        drive_change_(errors.slope().size()) {}

  void add_to(std::span<double> variance, double sigma_ratio) noexcept override {
    add_readings(variance, sigma_ratio);
    if (errors_.drivers() > 0) add_drivers(variance);
  }

 private:
  void add_readings(std::span<double> variance, double sigma_ratio) noexcept {
    const std::size_t taxels = variance.size();
    auto& matrix = inverse_.matrix();
    circuit_.model().taxel_jacobian({matrix.data(), taxels * taxels});
    const Eigen::Map<const Eigen::VectorXd> row_scale(equations_.row_scale().data(), matrix.rows());
    const Eigen::Map<const Eigen::VectorXd> column_scale(equations_.column_scale().data(), matrix.cols());
    for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
      matrix.row(k).array() *= row_scale(k) * column_scale.transpose().array();
    }
    inverse_.invert();
    for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
      const double square = matrix.row(k).cwiseProduct(row_scale.transpose()).squaredNorm();
      variance[static_cast<std::size_t>(k)] += sigma_ratio * sigma_ratio * square;
    }
  }

  void add_drivers(std::span<double> variance) noexcept {
    const std::size_t taxels = variance.size();
    const std::size_t drivers = errors_.drivers();
    multiply(StridedMatrix<double>{inverse_.matrix().data(), taxels, 1}, errors_.slope().data(), taxels, taxels,
             drivers, drive_change_.data());
    for (std::size_t k = 0; k < taxels; ++k) {
      double common = 0.0;
      double square = 0.0;
      for (std::size_t driver = 0; driver < drivers; ++driver) {
        const double own = driver == circuit_.readings()[k].driver ? alone(circuit_, equations_, k) : 0.0;
        const double error = errors_.ohm()[driver] * (-drive_change_[k * drivers + driver] - own);
        common += error;
        square += error * error;
      }
      variance[k] += errors_.correlation() * common * common + (1.0 - errors_.correlation()) * square;
    }
  }

  ScaledCircuit& circuit_;
  NewtonEquations& equations_;
  const DriverErrors& errors_;
  DenseInverse inverse_;
  std::vector<double> drive_change_;  // what an ohm makes of the taxels, in units of the equations [taxels, drivers]
};

/// The variance of a taxel over readings and drivers of random signs.
class SampledNoise final : public NewtonNoise {
 public:
  SampledNoise(ScaledCircuit& circuit, NewtonEquations& equations, const DriverErrors& errors)
      : circuit_(circuit), equations_(equations), errors_(errors), drawn_ohm_(errors.drivers()) {}

  void add_to(std::span<double> variance, double sigma_ratio) noexcept override {
    Random random(kNoiseSeed);
    equations_.release_taxels();
    for (int sample = 0; sample < kNoiseSamples; ++sample) {
      draw_readings(random, sigma_ratio);
      draw_drivers(random);
      equations_.solve(0.0, kAccuracy);
      for (std::size_t k = 0; k < variance.size(); ++k) {
        const double own =
            drawn_ohm_.empty() ? 0.0 : alone(circuit_, equations_, k) * drawn_ohm_[circuit_.readings()[k].driver];
        const double error = equations_.solution()[k] - own;
        variance[k] += error * error / kNoiseSamples;
      }
    }
  }

 private:
  void draw_readings(Random& random, double sigma_ratio) noexcept {
    std::vector<double>& right = equations_.right();
    for (std::size_t k = 0; k < right.size(); ++k) {
      right[k] = random_sign(random) * sigma_ratio * equations_.row_scale()[k];
    }
  }

  void draw_drivers(Random& random) noexcept {
    if (drawn_ohm_.empty()) return;
    const std::size_t drivers = drawn_ohm_.size();
    const double common = std::sqrt(errors_.correlation()) * random_sign(random);
    const double own = std::sqrt(1.0 - errors_.correlation());
    for (std::size_t driver = 0; driver < drivers; ++driver) {
      drawn_ohm_[driver] = errors_.ohm()[driver] * (common + own * random_sign(random));
    }
    for (std::size_t k = 0; k < errors_.slope().size(); ++k) {
      equations_.right()[k / drivers] -= errors_.slope()[k] * drawn_ohm_[k % drivers];
    }
  }

  ScaledCircuit& circuit_;
  NewtonEquations& equations_;
  const DriverErrors& errors_;
  std::vector<double> drawn_ohm_;  // [drivers]
};

}  // namespace

DriverErrors::DriverErrors(const ArrayDescription& array, bool are_counted)
    : correlation_(array.readout.drive_error_correlation) {
  if (!are_counted || is_absent(array.readout.drive_error_ohm)) return;
  ohm_ = array.readout.drive_error_ohm;
  slope_.resize(array.taxel_count() * ohm_.size());
}

void DriverErrors::find_slopes(ScaledCircuit& circuit, const NewtonEquations& equations) noexcept {
  if (ohm_.empty()) return;
  circuit.model().drive_jacobian(slope_);
  for (std::size_t k = 0; k < slope_.size(); ++k) slope_[k] *= equations.row_scale()[k / ohm_.size()];
}

std::unique_ptr<NewtonNoise> make_newton_noise(ScaledCircuit& circuit, NewtonEquations& equations,
                                               const DriverErrors& errors, const InversionOptions& options) {
  if (!options.samples_noise && circuit.x().size() <= kMostInvertedTaxels) {
    return std::make_unique<ExactNoise>(circuit, equations, errors);
  }
  return std::make_unique<SampledNoise>(circuit, equations, errors);
}

}  // namespace dermis::touch::compensation
