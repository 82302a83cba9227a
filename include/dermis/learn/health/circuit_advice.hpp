// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::health {

/// Relative 1-sigma of a conductance from the noise of the ADC in one frame. It covers the pressed taxels of several
/// contact patterns: a whole array pressed, a tenth of it, a row, a column, one taxel.
struct Precision {
  double mean = 0.0;  ///< Geometric mean; it decides.
  double median = 0.0;
  double p95 = 0.0;
  double worst = 0.0;
};

/// Least and greatest resistance of a taxel [ohm], 0 < least < most.
struct TaxelRange {
  double least_ohm = 0.0;
  double most_ohm = 0.0;
};

struct ResistorChoice {
  double load_ohm = 0.0;               ///< On every sensed line.
  std::optional<Precision> precision;  ///< Empty: readings leave the range of the ADC, or have no solution.
};

/// Which load and drive resistances give the smallest error.
struct CircuitAdvice {
  TaxelRange taxels;
  double noise_ratio = 0.0;                ///< Standard deviation of a reading over the supply.
  std::vector<ResistorChoice> loads;       ///< Rising.
  std::size_t best = 0;                    ///< Of `loads`: the least mean.
  std::optional<Precision> present;        ///< With the resistances that the array has now.
  std::optional<Precision> ideal_drivers;  ///< With the best load and drivers of 0 ohm.
  double most_drive_ohm = 0.0;             ///< With the best load: where the mean is 10 % above that of ideal drivers.
};

/// Standard deviation of a reading over the supply by the noise of the ADC. Errors: a reference in volts without a
/// nominal supply.
[[nodiscard]] Result<double> adc_noise_ratio(const ArrayDescription& array);

/// For taxels of that range, log-uniform, in the circuit of the array, which must be known, with the noise of its ADC.
/// Loads from least_ohm/100 to 10 most_ohm are tried. Deterministic. `progress` gets the share that is done. Errors: no
/// load gives readings that the ADC can take; those of adc_noise_ratio().
[[nodiscard]] Result<CircuitAdvice> advise_circuit(const ArrayDescription& array, const TaxelRange& taxels,
                                                   const std::function<void(double share)>& progress);

/// The advice for the array as lines of text: what was tried, then what to take.
[[nodiscard]] std::string describe(const CircuitAdvice& advice, const ArrayDescription& array);

}  // namespace dermis::learn::health
