// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/grounded_divider.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::compensation {
namespace {

constexpr int kMaxSteps = 200;
constexpr double kTolerance = 1e-7;       // largest change of a conductance, relative to the loaded column
constexpr double kColumnShareCap = 0.9999;  // 1 - sigma stays positive under noise
constexpr double kHalvedStep = 0.5;

}  // namespace

GroundedDivider::GroundedDivider(const ArrayDescription& array)
    : rows_(array.rows),
      cols_(array.cols),
      drive_ohm_(array.readout.drive_ohm),
      column_siemens_(cols_),
      weighted_ratio_(rows_ * cols_),
      coupling_(cols_ * cols_),
      undriven_(rows_ * cols_),
      column_share_(cols_) {
  for (const double ohm : array.readout.load_ohm) load_siemens_.push_back(1.0 / ohm);
}

bool GroundedDivider::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  start(ratio, siemens);
  double damping = 1.0;
  double last_change = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxSteps; ++k) {
    const double change = step(ratio, siemens, damping);
    if (change <= kTolerance * damping) return true;
    if (!(change < last_change)) damping = kHalvedStep;
    last_change = change;
  }
  return false;
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
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      const double difference = damping * (column_siemens_[col] * undriven_[taxel] - siemens[taxel]);
      siemens[taxel] += difference;
      change = std::max(change, std::abs(difference) / column_siemens_[col]);
    }
  }
  return std::isfinite(change) ? change : std::numeric_limits<double>::infinity();
}

void GroundedDivider::undo_drivers(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  std::copy(load_siemens_.begin(), load_siemens_.end(), column_siemens_.begin());
  std::fill(coupling_.begin(), coupling_.end(), 0.0);
  for (std::size_t row = 0; row < rows_; ++row) {
    const double* conductance = &siemens[row * cols_];
    const double* weighted = &weighted_ratio_[row * cols_];
    for (std::size_t j = 0; j < cols_; ++j) {
      column_siemens_[j] += conductance[j];
      double* coupling = &coupling_[j * cols_];
      for (std::size_t col = 0; col < cols_; ++col) coupling[col] += conductance[j] * weighted[col];
    }
  }
  for (std::size_t j = 0; j < cols_; ++j) {
    double* coupling = &coupling_[j * cols_];
    for (std::size_t col = 0; col < cols_; ++col) coupling[col] /= column_siemens_[j];
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    const double* conductance = &siemens[row * cols_];
    double row_siemens = 0.0;
    for (std::size_t j = 0; j < cols_; ++j) row_siemens += conductance[j];
    const double line_gain = 1.0 + drive_ohm_[row] * row_siemens;
    double* undriven = &undriven_[row * cols_];
    for (std::size_t col = 0; col < cols_; ++col) undriven[col] = line_gain * ratio[row * cols_ + col];
    for (std::size_t j = 0; j < cols_; ++j) {
      const double* coupling = &coupling_[j * cols_];
      for (std::size_t col = 0; col < cols_; ++col) undriven[col] -= conductance[j] * coupling[col];
    }
  }
}

}  // namespace dermis::compensation
