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
      correlation_(array.readout.drive_error_correlation),
      load_ohm_(array.readout.load_ohm),
      has_potential_(array.readout.circuit != Circuit::transimpedance),
      idle_lines_float_(array.readout.idle_rows == IdleRows::floating && array.readout.circuit != Circuit::flexitac),
      driven_stride_(array.cols),
      sensed_stride_(1) {
  if (array.readout.circuit == Circuit::flexitac) std::swap(driven_stride_, sensed_stride_);
  if (!has_potential_) std::fill(load_ohm_.begin(), load_ohm_.end(), 0.0);
  if (array.readout.circuit == Circuit::none) drive_error_ohm_.clear();
  if (drive_error_ohm_.empty()) return;
  current_.resize(array.driven_lines());
  own_.resize(array.driven_lines());
  lifted_.resize(array.driven_lines() * array.driven_lines());
  common_.resize(array.sensed_lines());
  square_.resize(array.sensed_lines());
}

void DriverError::add(std::span<const double> siemens, std::span<const double> ratio,
                      std::span<double> sigma_siemens) noexcept {
  if (drive_error_ohm_.empty()) return;
  find_currents(siemens, ratio);
  for (std::size_t driven = 0; driven < current_.size(); ++driven) {
    std::fill(common_.begin(), common_.end(), 0.0);
    std::fill(square_.begin(), square_.end(), 0.0);
    if (idle_lines_float_) {
      add_driver(driven, driven, siemens);
    } else {
      for (std::size_t driver = 0; driver < current_.size(); ++driver) add_driver(driven, driver, siemens);
    }
    for (std::size_t sensed = 0; sensed < common_.size(); ++sensed) {
      double& sigma = sigma_siemens[at(driven, sensed)];
      const double of_drivers =
          correlation_ * common_[sensed] * common_[sensed] + (1.0 - correlation_) * square_[sensed];
      sigma = std::sqrt(sigma * sigma + of_drivers);
    }
  }
}

void DriverError::find_currents(std::span<const double> siemens, std::span<const double> ratio) noexcept {
  const std::size_t lines = current_.size();
  std::fill(lifted_.begin(), lifted_.end(), 0.0);
  for (std::size_t k = 0; k < lines; ++k) {
    own_[k] = 0.0;
    for (std::size_t j = 0; j < common_.size(); ++j) {
      own_[k] += siemens[at(k, j)] * (has_potential_ ? 1.0 - ratio[at(k, j)] : 1.0);
    }
    current_[k] = own_[k];
    if (!has_potential_ || idle_lines_float_) continue;
    for (std::size_t i = 0; i < lines; ++i) {
      if (i == k) continue;
      double& lifted = lifted_[i * lines + k];
      for (std::size_t j = 0; j < common_.size(); ++j) lifted += siemens[at(k, j)] * ratio[at(i, j)];
      current_[k] -= lifted;
    }
  }
}

void DriverError::add_driver(std::size_t driven, std::size_t driver, std::span<const double> siemens) noexcept {
  const double error_ohm = drive_error_ohm_[driver];
  const double lifted = lifted_[driven * current_.size() + driver];
  for (std::size_t j = 0; j < common_.size(); ++j) {
    const double conductance = siemens[at(driven, j)];
    const double of_driver = siemens[at(driver, j)];
    double error = of_driver * (load_ohm_[j] * conductance * current_[driver] - lifted);
    if (driver == driven) error += conductance * (own_[driver] - conductance);
    error *= error_ohm;
    common_[j] += error;
    square_[j] += error * error;
  }
}

}  // namespace dermis::compensation
