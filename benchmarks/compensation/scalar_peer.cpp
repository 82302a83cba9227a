// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The mathematics of dermis in plain loops, as a careful programmer writes them for one's own array.
#include <algorithm>
#include <cmath>
#include <vector>

#include "compensation/peers.hpp"

namespace dermis::benchmarks {
namespace {

constexpr int kMostSteps = 200;

class ScalarPeer final : public Peer {
 public:
  explicit ScalarPeer(const ArrayDescription& array)
      : rows_(array.rows),
        cols_(array.cols),
        drive_ohm_(array.readout.drive_ohm),
        load_ohm_(array.readout.load_ohm),
        explained_(rows_ * cols_),
        coupling_(cols_ * cols_),
        returned_(rows_ * cols_),
        line_gain_(rows_),
        column_siemens_(cols_) {}

  [[nodiscard]] std::string name() const override { return "scalar"; }

  void start(std::span<const double> ratio, std::span<double> siemens) override {
    for (std::size_t j = 0; j < cols_; ++j) {
      double sum = 0.0;
      for (std::size_t i = 0; i < rows_; ++i) sum += std::max(ratio[i * cols_ + j], 0.0);
      for (std::size_t i = 0; i < rows_; ++i) {
        siemens[i * cols_ + j] = std::max(ratio[i * cols_ + j], 0.0) / (load_ohm_[j] * (1.0 - sum));
      }
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < cols_; ++j) sum += siemens[i * cols_ + j];
      for (std::size_t j = 0; j < cols_; ++j) siemens[i * cols_ + j] /= 1.0 - drive_ohm_[i] * sum;
    }
  }

  void invert(std::span<const double> ratio, double tolerance, std::span<double> siemens) override {
    std::copy(ratio.begin(), ratio.end(), explained_.begin());
    for (int step = 0; step < kMostSteps; ++step) {
      find_returned(siemens);
      if (certificate(siemens) <= tolerance) return;
      for (std::size_t j = 0; j < cols_; ++j) {
        double sum = 0.0;
        for (std::size_t i = 0; i < rows_; ++i) {
          sum += line_gain_[i] * explained_[i * cols_ + j] - returned_[i * cols_ + j];
        }
        const double scale = 1.0 / (load_ohm_[j] * (1.0 - sum));
        for (std::size_t i = 0; i < rows_; ++i) {
          const std::size_t k = i * cols_ + j;
          siemens[k] = std::max(line_gain_[i] * ratio[k] - returned_[k], 0.0) * scale;
          explained_[k] = std::max(ratio[k], returned_[k] / line_gain_[i]);
        }
      }
    }
  }

  void forward(std::span<const double> siemens, std::span<double> ratio) override { solve<double>(siemens, ratio); }
  void forward(std::span<const float> siemens, std::span<float> ratio) override { solve<float>(siemens, ratio); }

 private:
  void find_returned(std::span<const double> siemens) {
    for (std::size_t j = 0; j < cols_; ++j) column_siemens_[j] = 1.0 / load_ohm_[j];
    for (std::size_t i = 0; i < rows_; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < cols_; ++j) {
        sum += siemens[i * cols_ + j];
        column_siemens_[j] += siemens[i * cols_ + j];
      }
      line_gain_[i] = 1.0 + drive_ohm_[i] * sum;
    }
    std::fill(coupling_.begin(), coupling_.end(), 0.0);
    std::fill(returned_.begin(), returned_.end(), 0.0);
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t l = 0; l < cols_; ++l) {
        const double factor = siemens[i * cols_ + l] * drive_ohm_[i] / column_siemens_[l];
        for (std::size_t j = 0; j < cols_; ++j) coupling_[l * cols_ + j] += factor * explained_[i * cols_ + j];
      }
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t l = 0; l < cols_; ++l) {
        const double factor = siemens[i * cols_ + l];
        for (std::size_t j = 0; j < cols_; ++j) returned_[i * cols_ + j] += factor * coupling_[l * cols_ + j];
      }
    }
  }

  [[nodiscard]] double certificate(std::span<const double> siemens) const {
    double largest = 0.0;
    for (std::size_t j = 0; j < cols_; ++j) {
      double worst = 0.0;
      double spread = 0.0;
      for (std::size_t i = 0; i < rows_; ++i) {
        const std::size_t k = i * cols_ + j;
        const double undriven = line_gain_[i] * explained_[k] - returned_[k];
        const double residual = std::abs(undriven - siemens[k] / column_siemens_[j]);
        worst = std::max(worst, residual);
        spread += residual * (1.0 - 1.0 / line_gain_[i]);
      }
      largest = std::max(largest, worst + spread);
    }
    return largest;
  }

  /// Rows eliminated, then Cholesky's factors of the columns' matrix.
  template <typename Real>
  void solve(std::span<const Real> siemens, std::span<Real> ratio) {
    std::vector<Real> matrix(cols_ * cols_, Real{0});
    std::vector<Real> line_ratio(rows_);
    for (std::size_t j = 0; j < cols_; ++j) matrix[j * cols_ + j] = 1 / static_cast<Real>(load_ohm_[j]);
    for (std::size_t i = 0; i < rows_; ++i) {
      const Real* const line = &siemens[i * cols_];
      Real sum{0};
      for (std::size_t j = 0; j < cols_; ++j) sum += line[j];
      line_ratio[i] = 1 / (1 + static_cast<Real>(drive_ohm_[i]) * sum);
      const Real weight = static_cast<Real>(drive_ohm_[i]) * line_ratio[i];
      for (std::size_t j = 0; j < cols_; ++j) {
        matrix[j * cols_ + j] += line[j];
        for (std::size_t l = 0; l <= j; ++l) matrix[j * cols_ + l] -= weight * line[j] * line[l];
      }
    }
    for (std::size_t j = 0; j < cols_; ++j) {
      for (std::size_t l = 0; l <= j; ++l) {
        Real value = matrix[j * cols_ + l];
        for (std::size_t k = 0; k < l; ++k) value -= matrix[j * cols_ + k] * matrix[l * cols_ + k];
        matrix[j * cols_ + l] = l == j ? std::sqrt(value) : value / matrix[l * cols_ + l];
      }
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      Real* const out = &ratio[i * cols_];
      for (std::size_t j = 0; j < cols_; ++j) {
        Real value = line_ratio[i] * siemens[i * cols_ + j];
        for (std::size_t k = 0; k < j; ++k) value -= matrix[j * cols_ + k] * out[k];
        out[j] = value / matrix[j * cols_ + j];
      }
      for (std::size_t j = cols_; j-- > 0;) {
        Real value = out[j];
        for (std::size_t k = j + 1; k < cols_; ++k) value -= matrix[k * cols_ + j] * out[k];
        out[j] = value / matrix[j * cols_ + j];
      }
    }
  }

  std::size_t rows_;
  std::size_t cols_;
  std::vector<double> drive_ohm_;
  std::vector<double> load_ohm_;
  std::vector<double> explained_;
  std::vector<double> coupling_;
  std::vector<double> returned_;
  std::vector<double> line_gain_;
  std::vector<double> column_siemens_;
};

}  // namespace

std::unique_ptr<Peer> scalar_peer(const ArrayDescription& array) {
  return std::make_unique<ScalarPeer>(array);
}

}  // namespace dermis::benchmarks
