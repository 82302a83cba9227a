// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::devices {

/// The shape of a frame of which only the number of taxels is known: square, 2x2 or more; else empty.
[[nodiscard]] inline std::optional<FrameShape> square_shape(std::size_t taxels) {
  constexpr std::size_t kSmallest = 4;
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(taxels))));
  if (taxels < kSmallest || side * side != taxels) return std::nullopt;
  return FrameShape{side, side};
}

}  // namespace dermis::bytes::devices
