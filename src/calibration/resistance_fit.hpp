// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "calibration/circuit_frames.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"

namespace dermis::calibration {

/// The conductance of a taxel, over a reference conductance of the array. t: temperature, x: logarithm of the force,
/// both scaled to about [-1, 1].
struct TaxelLaw {
  Eigen::VectorXd unloaded;  ///< u = a + b t + c t^2; empty: never seen idle.
  Eigen::VectorXd pressed;   ///< ln(g - u) = a + b x + c t + d x^2 + e x^3 + f t^2 + g t x; empty: never pressed.
};

/// x = (ln F - centre) / half_span.
struct ForceScale {
  double centre = 0.0;
  double half_span = 1.0;
};

/// The resistances of one circuit that fit the frames best.
struct ResistanceFit {
  ArrayDescription array;           ///< With numbers for all resistances.
  std::vector<double> drive_error;  ///< Relative standard errors; 0: given.
  std::vector<double> load_error;
  double common_drive_error = 0.0;
  double rubber_scatter = 0.0;    ///< Of a pressed taxel about its law, relative.
  double noise = 0.0;             ///< Scatter of the idle readings about their laws, in their standard deviations.
  double sheet_scatter = 0.0;     ///< Unloaded conductance from line to line, relative.
  std::size_t idle_readings = 0;  ///< Idle readings that are large enough to tell something.
  std::size_t pressed_readings = 0;
  std::size_t unsolved = 0;   ///< Frames that this circuit cannot give.
  bool has_absolute = false;  ///< A resistance was given; if not, the loads' geometric mean is kNominalLoadOhm.
  double reference_siemens = 0.0;
  std::vector<TaxelLaw> laws;
  Eigen::VectorXd common;  ///< What the pressed laws have in common.
  ForceScale force_scale;
};

inline constexpr double kNominalLoadOhm = 1000.0;

/// Fits the resistances of `array` that are kFitOhm. `array` has a circuit, not Circuit::automatic; where all is known
/// only the laws are fitted. Errors: a circuit that cannot be inverted, no resistances with which it explains frames.
[[nodiscard]] Result<ResistanceFit> fit_resistances(const ArrayDescription& array, const CircuitFrames& frames);

/// Mean square of what the fitted circuit leaves of each frame, in standard deviations of the readings, each reading's
/// share cut at `cut`; `cut` for frames that it cannot give, NaN for frames without a reading to judge by.
[[nodiscard]] std::vector<double> judge_frames(const ResistanceFit& fit, const CircuitFrames& frames, double cut);

}  // namespace dermis::calibration
