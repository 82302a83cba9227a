// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dermis::bytes::proposals {

using Bytes = std::vector<std::uint8_t>;

/// Packets of equal size that a stream may consist of.
struct Packets {
  std::size_t size = 0;
  std::vector<Bytes> packets{};       ///< The first of them, escapes undone.
  std::vector<std::size_t> places{};  ///< Where they begin in the stream; empty of those with escapes.
  std::size_t mark_size = 0;          ///< So many bytes at the beginning are the same in all.
  std::size_t end_mark_size = 0;      ///< So many bytes at the end mark it, where none at the beginning do.
  std::string escape{};               ///< As in a layout; empty: they begin with a mark.
};

/// The likeliest ways to cut the bytes into packets. `sizes`: those of frames without a mark that are likely.
[[nodiscard]] std::vector<Packets> packets_in(std::span<const std::uint8_t> bytes,
                                              const std::vector<std::size_t>& sizes);

/// Whether a byte is the same in all packets, but for some that are damaged.
[[nodiscard]] bool is_constant(const Packets& packets, std::size_t at);

}  // namespace dermis::bytes::proposals
