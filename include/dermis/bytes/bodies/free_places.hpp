// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis {

/// A taxel on a flat picture of its array: x to the right, y down [m].
struct FreePlace {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;  ///< A disc that touches no other.
};

/// The taxels of an array in no grid: one row or column of them whose places are not evenly on a line. The
/// shortest of the three axes is left out. Empty: the array is a grid.
[[nodiscard]] std::vector<FreePlace> free_places(FrameShape array, const ArrayShape& shape);

}  // namespace dermis
