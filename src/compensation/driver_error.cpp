// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/driver_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace dermis::compensation {

DriverError::DriverError(const ArrayDescription& array)
    : drive_error_ohm_(array.readout.drive_error_ohm),
      load_ohm_(array.readout.load_ohm),
      driven_stride_(array.cols),
      sensed_stride_(1),
      driven_(array.driven_lines()),
      sensed_(array.sensed_lines()) {
  if (array.readout.circuit == Circuit::flexitac) std::swap(driven_stride_, sensed_stride_);
  if (array.readout.circuit == Circuit::transimpedance) std::fill(load_ohm_.begin(), load_ohm_.end(), 0.0);
  if (array.readout.circuit == Circuit::none) drive_error_ohm_.clear();
}

void DriverError::add(std::span<const double> siemens, std::span<double> sigma_siemens) noexcept {
  if (drive_error_ohm_.empty()) return;
  std::fill(sensed_.begin(), sensed_.end(), 0.0);
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < sensed_.size(); ++j) sum += siemens[i * driven_stride_ + j * sensed_stride_];
    driven_[i] = drive_error_ohm_[i] * sum;
    for (std::size_t j = 0; j < sensed_.size(); ++j) {
      sensed_[j] += load_ohm_[j] * siemens[i * driven_stride_ + j * sensed_stride_] * driven_[i];
    }
  }
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    for (std::size_t j = 0; j < sensed_.size(); ++j) {
      const std::size_t taxel = i * driven_stride_ + j * sensed_stride_;
      const double conductance = siemens[taxel];
      const double alone = drive_error_ohm_[i] * conductance * (1.0 + load_ohm_[j] * conductance);
      const double error = (driven_[i] + sensed_[j] - alone) * conductance;
      sigma_siemens[taxel] = std::sqrt(sigma_siemens[taxel] * sigma_siemens[taxel] + error * error);
    }
  }
}

}  // namespace dermis::compensation
