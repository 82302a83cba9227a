// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace dermis::bytes::files {

/// Whether u16 holds all counts with every bit: whole, not negative, not -0.
[[nodiscard]] inline bool fit_u16(std::span<const float> counts) {
  constexpr auto kMost = std::bit_cast<std::uint32_t>(65535.0F);  // of what is positive, bits rise with the number
  std::uint32_t differing = 0;                                    // without a branch: compilers use vectors
  for (const float count : counts) {
    const auto bits = std::bit_cast<std::uint32_t>(count);
    const std::uint32_t mask = 0U - static_cast<std::uint32_t>(bits <= kMost);
    const auto whole = static_cast<float>(static_cast<std::int32_t>(std::bit_cast<float>(bits & mask)));
    differing |= bits ^ std::bit_cast<std::uint32_t>(whole);
  }
  return differing == 0;
}

}  // namespace dermis::bytes::files
