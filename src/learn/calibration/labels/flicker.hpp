// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// Single taxels, rising, whose readings jump to and fro from frame to frame while nothing is on the array, like a
/// loose contact. Frames that are called unloaded and are not rise and fall once. Empty where that cannot be
/// determined, or where many taxels do: then no taxel is broken. Some taxel of the array never does.
[[nodiscard]] std::vector<std::size_t> find_flickering_taxels(const ArrayDescription& array,
                                                              std::span<const RawFrame> frames,
                                                              std::span<const Load> loads);

}  // namespace dermis::learn::calibration
