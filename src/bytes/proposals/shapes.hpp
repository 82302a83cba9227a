// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "bytes/proposals/smoothness.hpp"
#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::proposals {

[[nodiscard]] bool is_known(const FrameShape& shape, const Known& known);

/// Shapes of arrays with so many readings, at most two choices, the likeliest first. `frames`: readings of the first of
/// them. Readings of one that are several times those of a known array are so many arrays side by side.
[[nodiscard]] std::vector<std::vector<FrameShape>> shapes_of(const std::vector<std::size_t>& sizes,
                                                             const Readings& frames, const Known& known);

}  // namespace dermis::bytes::proposals
