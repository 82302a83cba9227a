// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dermis::touch::fusion {

/// Tables from conductance to force, for taxels whose calibration was better with a table than with a network
/// (docs/reasons/calibration.md, "Never worse than a table"). Straight lines through the knots:
///
///   s = e * (1 + per_celsius * dT)       e: excess over the unloaded taxel, dT: from the centre of the calibration
///
/// the first from (0 S, 0 N) to the first knot. Beyond the last knot force rises with the power end_exponent() of s.
/// Const members are thread-safe.
struct ForceTables {
  std::vector<std::uint32_t> taxels;  ///< That have a table, rising.
  std::size_t knots = 0;              ///< Knots of each table, >= 1 where there is a table.
  std::vector<float> siemens;         ///< s [tables, knots], > 0, strictly rising along the knots.
  std::vector<float> newtons;         ///< [tables, knots], > 0, strictly rising along the knots.
  std::vector<float> per_celsius;     ///< [tables], 1/C

  /// Force of a table, and its derivatives by conductance and temperature.
  struct Value {
    float log_newtons = 0.0F;
    float exponent = 0.0F;     ///< d ln newtons / d ln e, > 0.
    float per_celsius = 0.0F;  ///< d ln newtons / dT at a fixed e [1/C].
  };

  /// `table` < taxels.size(), excess_siemens > 0.
  [[nodiscard]] Value at(std::size_t table, float excess_siemens, float temperature_offset) const noexcept;

  /// d ln newtons / d ln e beyond the last knot of a table: 0.3 ... 3. It is the slope from the knot nearest to half
  /// its heaviest force to the last; 1 with a single knot.
  [[nodiscard]] float end_exponent(std::size_t table) const noexcept;

  /// s at the end of the straight line from (0 S, 0 N) through the first knot [S]. The end is that knot, or a later one
  /// on the line. No load has determined the law below it.
  [[nodiscard]] float line_end_siemens(std::size_t table) const noexcept;

  /// For an array of `taxel_count` taxels all vectors have the right size and every number is in its range.
  [[nodiscard]] bool is_consistent(std::size_t taxel_count) const noexcept;
};

}  // namespace dermis::touch::fusion
