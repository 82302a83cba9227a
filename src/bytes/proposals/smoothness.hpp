// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::proposals {

using Readings = std::vector<std::vector<float>>;  ///< [frame][taxel]

/// How much neighbours in a row, or frames, differ beside any two readings: 0 smooth, 1 like noise.
[[nodiscard]] double roughness_along(const Readings& frames);
[[nodiscard]] double roughness_in_time(const Readings& frames);

/// Rows and columns of frames whose readings come row by row, the likeliest first. Empty where none is as known.
[[nodiscard]] std::vector<FrameShape> likely_shapes(const Readings& frames, std::size_t taxels, const Known& known);

}  // namespace dermis::bytes::proposals
