// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// At most `most` of `count` places, evenly.
[[nodiscard]] inline std::vector<std::size_t> even_choice(std::size_t count, std::size_t most) {
  const std::size_t chosen = std::min(count, most);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < chosen; ++k) places.push_back(k * count / chosen);
  return places;
}

}  // namespace dermis::learn::calibration
