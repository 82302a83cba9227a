// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/out/report/svg.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::out::report {

/// The tactile image of one frame at four stages: the raw reading, the conductance without crosstalk, the force by
/// dermis and the true force. The last two share one scale in newtons. r0c0 is at the top left, and taxels have the
/// shape of the array's pitches. The vectors of `example` have the size of the array.
[[nodiscard]] std::vector<Drawing> tactile_panels(const ArrayDescription& array,
                                                  const learn::calibration::TactileExample& example);

/// The same side by side, as one drawing.
[[nodiscard]] Drawing tactile_image(const ArrayDescription& array, const learn::calibration::TactileExample& example);

}  // namespace dermis::out::report
