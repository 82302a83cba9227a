// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/core/frame_source.hpp"
#include "dermis/describing/proposals.hpp"
#include "describing/smoothness.hpp"

namespace dermis::describing {

[[nodiscard]] bool is_known(const FrameShape& shape, const Known& known);

/// Shapes of arrays with so many readings, at most two choices, the likeliest first. `frames`: readings of the first of
/// them. Readings of one that are several times those of a known array are so many arrays side by side.
[[nodiscard]] std::vector<std::vector<FrameShape>> shapes_of(const std::vector<std::size_t>& sizes,
                                                             const Readings& frames, const Known& known);

}  // namespace dermis::describing
