// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/result.hpp"

namespace dermis {

/// Most rows, and most columns, of an array.
inline constexpr std::size_t kMaxLines = 1024;

/// How the array is wired to the ADC. Drawings: docs/circuits.md.
enum class Circuit {
  divider,         ///< Every column ends in a resistor to ground; the ADC reads the column voltage.
  transimpedance,  ///< Every column is held at 0 V (virtual ground); the ADC reads its current times load_ohm.
  none,            ///< Unknown: readings are taken as proportional to conductance.
};

/// What the rows that are not being scanned are tied to.
enum class IdleRows {
  grounded,  ///< Through their drive resistance to 0 V.
  floating,  ///< To nothing.
};

/// The path from taxel resistance to counts (the paper's Fig. 3).
struct Readout {
  Circuit circuit = Circuit::divider;
  IdleRows idle_rows = IdleRows::grounded;
  std::vector<double> drive_ohm;  ///< Resistance of each row driver [ohm], >= 0; size rows (empty for `none`).
  std::vector<double>
      load_ohm;       ///< Divider or feedback resistor of each column [ohm], > 0; size cols (empty for `none`).
  int adc_bits = 12;  ///< Resolution [bit], 1 ... 24.
  std::optional<double> adc_reference_v;  ///< Full scale of the ADC [V], > 0; empty: the supply itself (ratiometric).
  std::optional<double> supply_v;         ///< Nominal supply [V], > 0, for frames that carry none.
  bool pressure_raises_reading = true;    ///< false: the reading falls with pressure, and 1 - ratio is used.

  /// Largest count, 2^adc_bits - 1.
  [[nodiscard]] double full_scale_counts() const noexcept;
};

/// A resistive tactile array: rows are driven, columns are sensed; r0c0 is the corner next to the connector.
struct ArrayDescription {
  std::string name = "array";
  std::size_t rows = 0;                 ///< Driven lines, 1 ... kMaxLines.
  std::size_t cols = 0;                 ///< Sensed lines, 1 ... kMaxLines.
  double row_pitch_m = 0.010;           ///< Distance between neighbouring rows [m], > 0.
  double col_pitch_m = 0.010;           ///< Distance between neighbouring columns [m], > 0.
  std::optional<double> taxel_area_m2;  ///< Pressed area of a taxel [m2], > 0; needed for loads given as pressure.
  Readout readout;

  [[nodiscard]] std::size_t taxel_count() const noexcept { return rows * cols; }
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t col) const noexcept { return row * cols + col; }

  /// "r3c5" for a row-major index.
  [[nodiscard]] std::string taxel_name(std::size_t taxel) const;

  /// Names the first field that is out of its range, as "readout.load_ohm: ...".
  [[nodiscard]] Status validate() const;
};

[[nodiscard]] const char* to_string(Circuit circuit) noexcept;
[[nodiscard]] const char* to_string(IdleRows idle_rows) noexcept;

/// "r3c5", as in the headers of the CSV files.
[[nodiscard]] std::string taxel_name(std::size_t row, std::size_t col);

}  // namespace dermis
