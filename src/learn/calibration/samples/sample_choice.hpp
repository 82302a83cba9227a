// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {

/// Which frames become samples [frames]: all labelled ones, unless they would fill more than 180 MB. Then at most 4,000
/// of the frames that press in the same places do, or fewer, until they fit. Places that are pressed less often keep
/// all of theirs, and of unloaded frames a sixteenth of all samples stay. Those of one place are chosen evenly over
/// their forces, both ends included.
[[nodiscard]] std::vector<bool> choose_samples(std::size_t taxels, const LoadsOfFrames& loads);

}  // namespace dermis::learn::calibration
