// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/standard_errors.hpp"

namespace dermis::learn::calibration {

/// The resistances of one circuit that fit the frames best.
struct ResistanceFit {
  ArrayDescription array;  ///< With numbers for all resistances.
  StandardErrors errors;
  std::vector<PressPair> driver_presses;  ///< Presses that would determine the fitted drivers, see driver_presses().
  double rubber_scatter = 0.0;            ///< Relative standard deviation of a pressed taxel about its law.
  double sheet_scatter = 0.0;             ///< Unloaded conductance from line to line, relative; 0: not compared.
  bool has_idle_readings = false;         ///< Large enough to be evidence.
  bool has_absolute = false;  ///< A resistance was given; if not, the loads' geometric mean is kNominalLoadOhm.
};

/// Fits the resistances of `array` that are kFitOhm. `array` has a circuit, not Circuit::automatic; where all is known
/// only the laws are fitted. Errors: a circuit that cannot be inverted, no resistances with which it explains frames.
[[nodiscard]] Result<ResistanceFit> fit_resistances(const ArrayDescription& array, const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
