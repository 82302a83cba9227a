// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"

namespace dermis::app {

/// 1-sigma of a conductance from the noise of the ADC in one frame, relative, over the pressed taxels of several
/// contact patterns: a whole array pressed, a tenth of it, a row, a column, one taxel.
struct Precision {
  double mean = 0.0;  ///< Geometric: what is judged by.
  double median = 0.0;
  double p95 = 0.0;
  double worst = 0.0;
};

struct LoadChoice {
  double load_ohm = 0.0;               ///< On every sensed line.
  std::optional<Precision> precision;  ///< Empty: readings leave the range of the ADC, or have no solution.
};

struct Advice {
  std::vector<LoadChoice> loads;           ///< Rising.
  std::size_t best = 0;                    ///< Of `loads`: the least mean.
  std::optional<Precision> present;        ///< With the resistances that the array has now.
  std::optional<Precision> ideal_drivers;  ///< With the best load and drivers of 0 ohm.
  double most_drive_ohm = 0.0;             ///< With the best load: where the mean is 10 % above that of ideal drivers.
};

/// For taxels from `least_ohm` to `most_ohm`, log-uniform, and an ADC whose readings have a standard deviation of
/// `noise_ratio` over the supply. Loads from least_ohm/100 to 10 most_ohm are tried. Deterministic.
/// `progress` is told the share that is done. Errors: no load gives readings that the ADC can take.
[[nodiscard]] Result<Advice> advise(const ArrayDescription& array, double least_ohm, double most_ohm,
                                    double noise_ratio, const std::function<void(double share)>& progress);

}  // namespace dermis::app
