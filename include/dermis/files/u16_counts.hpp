// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace dermis::files {

/// Whether u16 holds all counts with every bit: whole, not negative, not -0.
[[nodiscard]] inline bool fit_u16(std::span<const float> counts) {
  return std::all_of(counts.begin(), counts.end(), [](float count) {
    if (!(count >= 0.0F && count <= 65535.0F)) return false;
    const auto whole = static_cast<float>(static_cast<std::uint16_t>(count));
    return std::bit_cast<std::uint32_t>(whole) == std::bit_cast<std::uint32_t>(count);
  });
}

}  // namespace dermis::files
