// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "learn/calibration/labels/frame_sums.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {

/// Says where labels fit frames up to 10 earlier or later clearly better than their own. The evidence is where the
/// array is pressed, which distinguishes equal forces in several places, or how hard. Empty where they do not.
[[nodiscard]] std::optional<std::string> remark_on_shift(std::span<const FrameSum> sums, const LoadsOfFrames& loads,
                                                         const ArrayDescription& array);

}  // namespace dermis::learn::calibration
