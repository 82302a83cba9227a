// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "calibration/labels/frame_sums.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/core/loads.hpp"

namespace dermis::calibration {

/// The error where loads of single taxels exchange row and column: nearly always r1c0 answers where r0c1 is named.
/// Empty where they do not, or fewer than three taxels show it. `sums`: of the frames of `loads`.
[[nodiscard]] std::optional<std::string> find_exchange(const ArrayDescription& array, std::span<const FrameSum> sums,
                                                       std::span<const Load> loads);

}  // namespace dermis::calibration
