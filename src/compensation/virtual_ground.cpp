// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/virtual_ground.hpp"

#include <algorithm>

namespace dermis::compensation {

VirtualGround::VirtualGround(const ArrayDescription& array) : drive_ohm_(array.readout.drive_ohm) {
  for (const double ohm : array.readout.load_ohm) load_siemens_.push_back(1.0 / ohm);
}

InversionResult VirtualGround::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  const std::size_t cols = load_siemens_.size();
  bool solvable = true;
  for (std::size_t row = 0; row < drive_ohm_.size(); ++row) {
    const std::span<const double> readings = ratio.subspan(row * cols, cols);
    const std::span<double> conductances = siemens.subspan(row * cols, cols);
    double row_siemens = 0.0;
    for (std::size_t col = 0; col < cols; ++col) {
      conductances[col] = readings[col] * load_siemens_[col];
      row_siemens += conductances[col];
    }
    const double line_ratio = 1.0 - drive_ohm_[row] * row_siemens;  // row voltage / supply
    if (line_ratio <= 0.0) {
      solvable = false;
      continue;
    }
    for (double& conductance : conductances) conductance = std::max(conductance / line_ratio, 0.0);
  }
  return {solvable, 0.0};
}

void VirtualGround::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  for (std::size_t taxel = 0; taxel < sigma_siemens.size(); ++taxel) {
    sigma_siemens[taxel] = sigma_ratio * load_siemens_[taxel % load_siemens_.size()];
  }
}

}  // namespace dermis::compensation
