// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/training/taxel_training.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "calibration/training/force_levels.hpp"
#include "calibration/training/temperature_levels.hpp"
#include "dermis/network/levenberg_marquardt.hpp"

namespace dermis::calibration {
namespace {

constexpr double kNoiseFloor = 0.003;  // relative; temperature and supply meters, repeatability
constexpr int kStarts = 6;
constexpr int kMaxIterations = 100;
constexpr double kRelativeReduction = 1e-5;

struct TrainingPoint {
  ForceNetwork::Inputs inputs;
  double log_newtons = 0.0;
  double weight = 0.0;  // 1 / standard deviation of ln(newtons)
};

double geometric_mean(std::span<const TaxelPoint> points, double TaxelPoint::*member) {
  double sum = 0.0;
  for (const TaxelPoint& point : points) sum += std::log(point.*member);
  return std::exp(sum / static_cast<double>(points.size()));
}

NetworkPrior prior_of(const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                      const TemperatureSpan& temperature) {
  NetworkPrior prior;
  if (count_levels(rising_loads(points)) < kLeastLevelsOfBend) prior.power = PowerPrior::straight;
  if (shape.inputs < fusion::kInputsWithTemperature) return prior;
  std::vector<WarmLoad> warm;
  for (const TaxelPoint& point : points) warm.push_back({point.load_newtons, point.temperature});
  prior.temperature = temperature_prior(std::move(warm), temperature);
  prior.half_span_celsius = temperature.half_span_celsius;
  return prior;
}

/// The points of a taxel as a problem of least squares.
class TaxelProblem {
 public:
  TaxelProblem(const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
               const TemperatureSpan& temperature)
      : prior_(prior_of(shape, points, temperature)) {
    network_.shape = shape;
    network_.reference_siemens = geometric_mean(points, &TaxelPoint::excess_siemens);
    network_.heaviest_siemens = 0.0;
    network_.parameters.resize(shape.parameter_count());
    typical_newtons_ = geometric_mean(points, &TaxelPoint::newtons);
    for (const TaxelPoint& point : points) {
      network_.heaviest_siemens = std::max(network_.heaviest_siemens, point.excess_siemens);
      network_.heaviest_newtons = std::max(network_.heaviest_newtons, point.newtons);
      points_.push_back({network_.inputs(point.excess_siemens, point.temperature), std::log(point.newtons),
                         1.0 / std::hypot(kNoiseFloor, point.noise_siemens / point.excess_siemens)});
      touches_.push_back(point.touch);
    }
  }

  [[nodiscard]] double typical_newtons() const { return typical_newtons_; }

  /// From the free parameters `start`, which become the best ones. Gives half the sum of squares.
  double minimise(std::vector<double>& start) {
    network::LevenbergMarquardtOptions options;
    options.max_iterations = kMaxIterations;
    options.relative_reduction = kRelativeReduction;
    return network::minimise(residual_function(), residual_count(), start, options).final_error;
  }

  /// Half the sum of squares.
  [[nodiscard]] double error(std::span<const double> free) {
    std::vector<double> residuals(residual_count());
    residual_function()(free, residuals, {});
    return 0.5 * std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
  }

  [[nodiscard]] ForceNetwork network_at(std::span<const double> free) {
    network::monotone::parameters(network_.shape, free, network_.parameters);
    ForceNetwork network = network_;
    network.fitted = network::fitted_residuals(residual_function(), points_.size(), residual_count(), free, touches_);
    double square = 0.0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      network.fitted[k].residual /= points_[k].weight;
      network.fitted[k].common /= points_[k].weight;
      square += std::pow(std::expm1(network.log_newtons(points_[k].inputs, {}) - points_[k].log_newtons), 2);
    }
    network.rms_error = std::sqrt(square / static_cast<double>(points_.size()));
    return network;
  }

 private:
  [[nodiscard]] std::size_t residual_count() const { return points_.size() + network_.shape.parameter_count(); }

  /// The residuals of the points, then those of the prior.
  [[nodiscard]] network::ResidualFunction residual_function() {
    return [this](std::span<const double> free, std::span<double> residuals, std::span<double> jacobian) {
      const std::size_t n = free.size();
      network::monotone::parameters(network_.shape, free, network_.parameters);
      for (std::size_t k = 0; k < points_.size(); ++k) {
        const TrainingPoint& point = points_[k];
        const std::span<double> row = jacobian.empty() ? jacobian : jacobian.subspan(k * n, n);
        residuals[k] = point.weight * (network_.log_newtons(point.inputs, row) - point.log_newtons);
        for (double& derivative : row) derivative *= point.weight;
      }
      prior_residuals(network_, prior_, 1.0, residuals.subspan(points_.size()),
                      jacobian.empty() ? jacobian : jacobian.subspan(points_.size() * n), n);
    };
  }

  ForceNetwork network_;  // its parameters are those that are tried last
  std::vector<TrainingPoint> points_;
  std::vector<std::size_t> touches_;  // of the points
  NetworkPrior prior_;
  double typical_newtons_ = 0.0;
};

/// The free values of a network's parameters.
std::vector<double> free_parameters(const ForceNetwork& network) {
  constexpr double kLeast = 1e-12;
  std::vector<double> free = network.parameters;
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (network::monotone::is_positive(network.shape, k)) free[k] = std::log(std::max(free[k], kLeast));
  }
  return free;
}

}  // namespace

std::vector<double> rising_loads(std::span<const TaxelPoint> points) {
  std::vector<double> newtons;
  for (const TaxelPoint& point : points) newtons.push_back(point.load_newtons);
  std::sort(newtons.begin(), newtons.end());
  return newtons;
}

ForceNetwork train_taxel(const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                         const TemperatureSpan& temperature, std::uint64_t seed) {
  TaxelProblem problem(shape, points, temperature);
  Random random(seed);
  std::vector<double> best;
  double best_error = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    std::vector<double> free = random_start(shape, problem.typical_newtons(), random);
    const double error = problem.minimise(free);
    if (!best.empty() && error >= best_error) continue;
    best = std::move(free);
    best_error = error;
  }
  return problem.network_at(best);
}

std::optional<ForceNetwork> train_taxel_like(std::span<const ForceNetwork> others,
                                             const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                                             const TemperatureSpan& temperature) {
  TaxelProblem problem(shape, points, temperature);
  std::vector<double> best;
  double best_error = 0.0;
  for (const ForceNetwork& other : others) {
    if (other.shape != shape) continue;
    std::vector<double> free = free_parameters(other);
    const double error = problem.error(free);
    if (!best.empty() && error >= best_error) continue;
    best = std::move(free);
    best_error = error;
  }
  if (best.empty()) return std::nullopt;
  problem.minimise(best);
  return problem.network_at(best);
}

}  // namespace dermis::calibration
