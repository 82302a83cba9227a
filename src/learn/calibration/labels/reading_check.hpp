// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// Fails, with the likely mend, where most loaded frames cannot be: a supply in millivolts, a temperature in kelvin, or
/// no reading but zeros. `loads`: as check_loads() wants them.
[[nodiscard]] Status check_readings(const ArrayDescription& array, std::span<const RawFrame> frames,
                                    std::span<const Load> loads);

}  // namespace dermis::learn::calibration
