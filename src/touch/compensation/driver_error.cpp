// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/driver_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "touch/compensation/matrix_product.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {

DriverError::DriverError(const ArrayDescription& array, std::vector<double> column_ohm)
    : rows_(array.rows),
      cols_(array.cols),
      one_loaded_(array.readout.idle_columns == IdleColumns::floating),
      has_potential_(!is_absent(column_ohm) || array.readout.film),
      drive_ohm_(array.readout.drive_ohm),
      drive_error_ohm_(array.readout.drive_error_ohm),
      correlation_(array.readout.drive_error_correlation),
      column_ohm_(std::move(column_ohm)),
      shunt_(cols_),
      shunted_(cols_ * rows_),
      apparent_(rows_ * cols_),
      apparent_sum_(rows_),
      column_share_(rows_ * cols_),
      column_gain_(rows_),
      lift_(rows_ * rows_),
      common_(cols_),
      square_(cols_) {}

void DriverError::add(const std::vector<double>& siemens, const std::vector<double>& current, std::size_t stride,
                      std::span<const double> between_rows, std::span<double> sigma_siemens) noexcept {
  find_columns(siemens.data(), current.data(), stride);
  find_lifts(siemens.data(), stride, between_rows);
  for (std::size_t row = 0; row < rows_; ++row) {
    std::fill(common_.begin(), common_.end(), 0.0);
    std::fill(square_.begin(), square_.end(), 0.0);
    for (std::size_t driver = 0; driver < rows_; ++driver) {
      if (has_potential_ || driver == row) add_driver(row, driver, &siemens[row * stride]);
    }
    for (std::size_t col = 0; col < cols_; ++col) {
      double& sigma = sigma_siemens[row * cols_ + col];
      const double of_drivers = correlation_ * common_[col] * common_[col] + (1.0 - correlation_) * square_[col];
      sigma = std::sqrt(sigma * sigma + of_drivers);
    }
  }
}

void DriverError::find_columns(const double* siemens, const double* current, std::size_t stride) noexcept {
  std::fill(apparent_sum_.begin(), apparent_sum_.end(), 0.0);
  for (std::size_t col = 0; col < cols_; ++col) {
    double sum = 0.0;
    double currents = 0.0;
    double dropped = 0.0;  // sum_i G_ij Rd_i y_ij
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::size_t k = row * stride + col;
      sum += siemens[k];
      currents += current[k];
      dropped += siemens[k] * drive_ohm_[row] * current[k];
    }
    const double ohm = column_ohm_[col];
    double part = 1.0 / (1.0 + ohm * sum);
    shunt_[col] = ohm * part;
    if (one_loaded_) {
      shunt_[col] = sum > 0.0 ? 1.0 / sum : 0.0;
      part *= 1.0 - dropped * shunt_[col];
    }
    const double taken = currents + dropped;
    for (std::size_t row = 0; row < rows_; ++row) {
      const double y = current[row * stride + col];
      const double apparent = y / part;
      const double of_one_load = taken > 0.0 ? siemens[row * stride + col] * y / taken : 0.0;
      apparent_[row * cols_ + col] = apparent;
      apparent_sum_[row] += apparent;
      column_share_[row * cols_ + col] = one_loaded_ ? of_one_load : ohm * apparent;
    }
  }
}

void DriverError::find_lifts(const double* siemens, std::size_t stride, std::span<const double> between_rows) noexcept {
  std::fill(lift_.begin(), lift_.end(), 0.0);
  if (has_potential_) {
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t col = 0; col < cols_; ++col) {
        shunted_[col * rows_ + row] = -shunt_[col] * siemens[row * stride + col];
      }
    }
    multiply(StridedMatrix<double>{siemens, stride, 1}, shunted_.data(), rows_, cols_, rows_, lift_.data());
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) lift_[row * rows_ + row] += siemens[row * stride + col];
  }
  for (std::size_t row = 0; row < between_rows.size(); ++row) {
    for (const std::size_t line : {row, row + 1}) lift_[line * rows_ + line] += between_rows[row];
    for (const std::size_t line : {row, row + 1}) lift_[line * rows_ + (2 * row + 1 - line)] -= between_rows[row];
  }
  std::fill(column_gain_.begin(), column_gain_.end(), one_loaded_ ? 1.0 : 0.0);
  for (std::size_t k = 0; k < lift_.size() && !one_loaded_; ++k) column_gain_[k % rows_] += lift_[k];
}

void DriverError::add_driver(std::size_t row, std::size_t driver, const double* siemens) noexcept {
  const double error_ohm = drive_error_ohm_[driver];
  const double lift = error_ohm * lift_[row * rows_ + driver];
  const double line = drive_ohm_[row] * lift * apparent_sum_[driver];
  const double column = error_ohm * column_gain_[driver];
  const double alone = row == driver ? error_ohm : 0.0;
  const double* const apparent = &apparent_[driver * cols_];
  const double* const column_share = &column_share_[driver * cols_];
  double* const common = common_.data();
  double* const square = square_.data();
  for (std::size_t col = 0; col < cols_; ++col) {
    const double g = siemens[col];
    const double error = lift * apparent[col] + g * (line + column * column_share[col] - alone * g);
    common[col] += error;
    square[col] += error * error;
  }
}

}  // namespace dermis::touch::compensation
