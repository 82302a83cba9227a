// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/virtual_ground.hpp"

#include <algorithm>
#include <cmath>

#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {

VirtualGround::VirtualGround(const ArrayDescription& array, bool counts_driver_errors)
    : drive_ohm_(array.readout.drive_ohm),
      line_gain_(array.rows, 1.0),
      siemens_(array.taxel_count()),
      current_(array.taxel_count()) {
  for (const double ohm : array.readout.load_ohm) load_siemens_.push_back(1.0 / ohm);
  if (counts_driver_errors && !is_absent(array.readout.drive_error_ohm)) {
    driver_error_.emplace(array, std::vector<double>(array.cols, 0.0));
  }
}

InversionResult VirtualGround::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  const std::size_t cols = load_siemens_.size();
  bool solvable = true;
  for (std::size_t row = 0; row < drive_ohm_.size(); ++row) {
    const std::span<const double> readings = ratio.subspan(row * cols, cols);
    const std::span<double> conductances = siemens.subspan(row * cols, cols);
    double row_current = 0.0;   // of the readings, over the supply
    double kept_siemens = 0.0;  // of taxels without one
    for (std::size_t col = 0; col < cols; ++col) {
      if (std::isnan(readings[col])) {
        kept_siemens += conductances[col];
      } else {
        row_current += std::max(readings[col], 0.0) * load_siemens_[col];  // held at 0 S below
      }
    }
    const double line_ratio = (1.0 - drive_ohm_[row] * row_current) / (1.0 + drive_ohm_[row] * kept_siemens);
    solvable = solvable && line_ratio > 0.0;
    line_gain_[row] = line_ratio > 0.0 ? 1.0 / line_ratio : 1.0;
    const double gain = std::isfinite(row_current) ? line_gain_[row] : 0.0;
    for (std::size_t col = 0; col < cols; ++col) {
      if (std::isnan(readings[col])) continue;
      conductances[col] = gain > 0.0 ? std::max(readings[col], 0.0) * load_siemens_[col] * gain : 0.0;
    }
  }
  std::copy(siemens.begin(), siemens.end(), siemens_.begin());
  return {solvable, 0.0};
}

/// dG_kj = a_k dy_kj + Rd_k G_kj sum_j' a_k dy_kj', a_k = 1 / (1 - Rd_k Y_k) = 1 + Rd_k sum_j G_kj.
void VirtualGround::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  const std::size_t cols = load_siemens_.size();
  double all_columns = 0.0;
  for (const double siemens : load_siemens_) all_columns += siemens * siemens;
  for (std::size_t taxel = 0; taxel < sigma_siemens.size(); ++taxel) {
    const std::size_t row = taxel / cols;
    const double square = load_siemens_[taxel % cols] * load_siemens_[taxel % cols];
    const double drop = drive_ohm_[row] * siemens_[taxel];
    const double variance = square * (1.0 + drop) * (1.0 + drop) + (all_columns - square) * drop * drop;
    sigma_siemens[taxel] = sigma_ratio * line_gain_[row] * std::sqrt(variance);
    current_[taxel] = siemens_[taxel] / line_gain_[row];
  }
  if (driver_error_) driver_error_->add(siemens_, current_, cols, {}, sigma_siemens);
}

}  // namespace dermis::touch::compensation
