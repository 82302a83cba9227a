// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/supply_error.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::touch::compensation {

SupplyError::SupplyError(const ArrayDescription& array)
    : cols_(array.cols),
      supply_noise_(array.readout.adc_reference_v ? array.readout.supply_noise : 0.0),
      row_ohm_(array.rows),
      column_ohm_(array.cols),
      row_gain_(array.rows),
      column_gain_(array.cols) {
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::divider || readout.circuit == Circuit::transimpedance) row_ohm_ = readout.drive_ohm;
  if (readout.circuit == Circuit::divider) column_ohm_ = readout.load_ohm;
  if (readout.circuit != Circuit::flexitac) return;
  column_ohm_ = readout.drive_ohm;
  row_ohm_ = readout.load_ohm;
}

void SupplyError::add(std::span<const double> siemens, double doubt, std::span<double> sigma_siemens) noexcept {
  const double supply_sigma = std::hypot(supply_noise_, doubt);
  if (supply_sigma == 0.0) return;
  std::fill(column_gain_.begin(), column_gain_.end(), 1.0);
  for (std::size_t row = 0; row < row_gain_.size(); ++row) {
    double row_siemens = 0.0;
    for (std::size_t col = 0; col < cols_; ++col) {
      row_siemens += siemens[row * cols_ + col];
      column_gain_[col] += column_ohm_[col] * siemens[row * cols_ + col];
    }
    row_gain_[row] = 1.0 + row_ohm_[row] * row_siemens;
  }
  for (std::size_t row = 0; row < row_gain_.size(); ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      double& sigma = sigma_siemens[row * cols_ + col];
      const double error = supply_sigma * row_gain_[row] * column_gain_[col] * siemens[row * cols_ + col];
      sigma = std::sqrt(sigma * sigma + error * error);
    }
  }
}

}  // namespace dermis::touch::compensation
