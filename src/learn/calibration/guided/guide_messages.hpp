// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/guided_calibration.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/guided/held_out_presses.hpp"

namespace dermis::learn::calibration {

/// "5 N (510 g)".
[[nodiscard]] std::string describe_weight(double newtons);

/// The instruction to a person in the stage `unloaded`.
[[nodiscard]] std::string describe_quiet(bool is_disturbed);

/// The instruction to a person in the stage `pressing`.
[[nodiscard]] std::string describe_press(const GuideState& state, const ArrayDescription& array);

/// Describes the stage `fitting`, of which that share is done after so many seconds.
[[nodiscard]] std::string describe_fitting(const GuidedPresses& presses, double share, double seconds);

/// Describes what a finished calibration reached and what it holds for.
[[nodiscard]] std::string describe_result(const Calibration& calibration, const GuideState& state,
                                          const GuidedPresses& presses);

}  // namespace dermis::learn::calibration
