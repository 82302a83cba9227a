// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// A question, where the heaviest loads would press with more than rubber bears, or with less than a dozen sheets of
/// paper. A load presses on the taxels that feel it, each with the area around it. Empty where the loads may be as they
/// are. `loads` as check_loads() wants them.
[[nodiscard]] std::optional<std::string> remark_on_units(const ArrayDescription& array,
                                                         std::span<const RawFrame> frames, std::span<const Load> loads);

}  // namespace dermis::learn::calibration
