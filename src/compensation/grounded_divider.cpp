// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/grounded_divider.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/matrix_product.hpp"

namespace dermis::compensation {
namespace {

constexpr int kMaxSteps = 200;
constexpr double kColumnShareCap = 0.9999;  // 1 - sigma stays positive under noise
constexpr double kHalvedStep = 0.5;
constexpr double kLeastDamping = 1.0 / 16.0;
constexpr double kRunawayChange = 1e3;  // of a conductance, relative to the loaded column

}  // namespace

GroundedDivider::GroundedDivider(const ArrayDescription& array, double tolerance_ratio)
    : rows_(array.rows),
      cols_(array.cols),
      tolerance_(tolerance_ratio),
      drive_ohm_(array.readout.drive_ohm),
      line_gain_(rows_),
      column_siemens_(cols_),
      weighted_ratio_(rows_ * cols_),
      coupling_(cols_ * cols_),
      undriven_(rows_ * cols_),
      column_share_(cols_) {
  for (const double ohm : array.readout.load_ohm) load_siemens_.push_back(1.0 / ohm);
}

InversionResult GroundedDivider::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  for (double damping = 1.0; damping >= kLeastDamping; damping *= kHalvedStep) {
    start(ratio, siemens);
    if (!iterate(ratio, siemens, damping)) continue;
    for (double& conductance : siemens) conductance = std::max(conductance, 0.0);
    return {true, tolerance_};
  }
  start(ratio, siemens);  // the best attempt: always finite, right for ideal drivers
  for (double& conductance : siemens) conductance = std::max(conductance, 0.0);
  return {false, 1.0};
}

void GroundedDivider::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  for (std::size_t taxel = 0; taxel < sigma_siemens.size(); ++taxel) {
    sigma_siemens[taxel] = sigma_ratio * column_siemens_[taxel % cols_] * line_gain_[taxel / cols_];
  }
}

bool GroundedDivider::iterate(std::span<const double> ratio, std::span<double> siemens, double damping) noexcept {
  double last_change = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxSteps; ++k) {
    const double change = step(ratio, siemens, damping);
    if (change <= tolerance_ * damping) return is_possible();
    if (!(change < kRunawayChange)) return false;
    if (!(change < last_change)) damping = std::max(damping * kHalvedStep, kLeastDamping);
    last_change = change;
  }
  return false;
}

bool GroundedDivider::is_possible() const noexcept {
  return std::all_of(column_share_.begin(), column_share_.end(), [](double share) { return share < kColumnShareCap; });
}

void GroundedDivider::start(std::span<const double> ratio, std::span<double> siemens) noexcept {
  std::fill(column_share_.begin(), column_share_.end(), 0.0);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      weighted_ratio_[taxel] = drive_ohm_[row] * ratio[taxel];
      column_share_[col] += ratio[taxel];
    }
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      siemens[taxel] = load_siemens_[col] * ratio[taxel] / (1.0 - std::min(column_share_[col], kColumnShareCap));
    }
  }
}

double GroundedDivider::step(std::span<const double> ratio, std::span<double> siemens, double damping) noexcept {
  undo_drivers(ratio, siemens);
  std::fill(column_share_.begin(), column_share_.end(), 0.0);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) column_share_[col] += undriven_[row * cols_ + col];
  }
  // B becomes the scale of each column: gL / (1 - sigma) = gL + G^T 1 at the solution.
  for (std::size_t col = 0; col < cols_; ++col) {
    column_siemens_[col] = load_siemens_[col] / (1.0 - std::min(column_share_[col], kColumnShareCap));
  }
  double change = 0.0;
  bool finite = true;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      const double difference = damping * (column_siemens_[col] * undriven_[taxel] - siemens[taxel]);
      siemens[taxel] += difference;
      change = std::max(change, std::abs(difference) / column_siemens_[col]);
      finite = finite && std::isfinite(difference);  // std::max would drop a NaN
    }
  }
  return finite ? change : std::numeric_limits<double>::infinity();
}

void GroundedDivider::undo_drivers(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  std::copy(load_siemens_.begin(), load_siemens_.end(), column_siemens_.begin());
  for (std::size_t row = 0; row < rows_; ++row) {
    double row_siemens = 0.0;
    for (std::size_t col = 0; col < cols_; ++col) {
      const double conductance = siemens[row * cols_ + col];
      row_siemens += conductance;
      column_siemens_[col] += conductance;
    }
    line_gain_[row] = 1.0 + drive_ohm_[row] * row_siemens;
  }
  const StridedMatrix transposed{siemens.data(), 1, cols_};
  multiply(transposed, weighted_ratio_.data(), cols_, rows_, cols_, coupling_.data());
  for (std::size_t j = 0; j < cols_; ++j) {
    const double column_ohm = 1.0 / column_siemens_[j];
    for (std::size_t col = 0; col < cols_; ++col) coupling_[j * cols_ + col] *= column_ohm;
  }
  multiply({siemens.data(), cols_, 1}, coupling_.data(), rows_, cols_, cols_, undriven_.data());
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      undriven_[taxel] = line_gain_[row] * ratio[taxel] - undriven_[taxel];
    }
  }
}

}  // namespace dermis::compensation
