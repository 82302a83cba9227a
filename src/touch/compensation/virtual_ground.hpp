// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "touch/compensation/driver_error.hpp"

namespace dermis::touch::compensation {

/// Columns at virtual ground, resistive row drivers: closed form, formula (2) of docs/reasons/derivations-circuits.md.
///
///   y_kj = ratio_kj / load_ohm_j,   Y_k = sum_j y_kj,   G_kj = y_kj / (1 - drive_ohm_k Y_k)
///
/// Idle rows carry no current, grounded or floating, as every column is at 0 V.
class VirtualGround final : public CrosstalkInversion {
 public:
  VirtualGround(const ArrayDescription& array, bool counts_driver_errors);
  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override {
    return *std::max_element(load_siemens_.begin(), load_siemens_.end());
  }

 private:
  std::vector<double> drive_ohm_;     // [rows]
  std::vector<double> load_siemens_;  // [cols]
  std::vector<double> line_gain_;     // a of the last frame [rows]
  std::vector<double> siemens_;       // of the last frame [rows, cols]
  std::vector<double> current_;       // y [rows, cols]
  std::optional<DriverError> driver_error_;
};

}  // namespace dermis::touch::compensation
