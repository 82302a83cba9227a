// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::fusion {

/// The input of a look-up table.
enum class LookUpSignal {
  reading,      ///< counts / full scale, as a microcontroller has it: crosstalk and supply are in it.
  conductance,  ///< After the crosstalk inversion.
};

/// The simplest estimator that people build: one table per taxel, signal -> force, straight lines between the knots
/// and clamped at the ends. The baselines of every evaluation.
///
///   s = signal * (1 + temperature_coefficient * (temperature - reference))
struct LookUpTables {
  std::string name;
  LookUpSignal signal = LookUpSignal::reading;
  double reference_celsius = 20.0;
  std::size_t knots = 0;                        ///< >= 2
  std::vector<double> knot_signal;              ///< [taxels, knots], rising along the knots
  std::vector<double> knot_newtons;             ///< [taxels, knots], rising along the knots
  std::vector<double> temperature_coefficient;  ///< [taxels], 1/C; 0 for none

  [[nodiscard]] std::size_t taxel_count() const noexcept { return temperature_coefficient.size(); }
  [[nodiscard]] bool is_consistent() const noexcept;

  /// signal [taxels] -> newtons [taxels]. Without a temperature the reference is taken. Thread-safe.
  void estimate(std::span<const double> signal_values, std::optional<double> temperature_celsius,
                std::span<float> newtons) const noexcept;
};

}  // namespace dermis::touch::fusion
