// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "learn/calibration/labels/frame_sums.hpp"

namespace dermis::learn::calibration {

/// The error where frames are turned against loads of single taxels: rows and columns are exchanged, or come in reverse
/// order. Nearly always r1c0 answers, for one, where r0c1 is named. Empty where they are not, or fewer than three
/// taxels show it. `sums`: of the frames of `loads`.
[[nodiscard]] std::optional<std::string> find_turn(const ArrayDescription& array, std::span<const FrameSum> sums,
                                                   std::span<const Load> loads);

}  // namespace dermis::learn::calibration
