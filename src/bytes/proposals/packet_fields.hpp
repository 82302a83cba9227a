// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bytes/proposals/packet_search.hpp"

namespace dermis::bytes::proposals {

/// Bytes of a packet that tell something else than readings.
struct PacketField {
  std::size_t at = 0;
  std::size_t size = 0;
  std::string field{};                   ///< As in a layout; "array" or "row" count in turn, and may be either.
  std::string order{};                   ///< "le", "be", or empty of one byte
  std::vector<std::uint64_t> numbers{};  ///< Of those that count in turn.
  std::string options{};                 ///< " *8 -8", as in a layout.
  char kind = 'u';                       ///< 'f': a float
};

/// Those in the bytes from `begin` to `end`, in order.
[[nodiscard]] std::vector<PacketField> fields_in(const Packets& packets, std::size_t begin, std::size_t end);

/// The high bytes of a counter or clock may not have changed yet: it takes those that are 0 between `begin` and `end`.
void widen(PacketField& field, const Packets& packets, std::size_t begin, std::size_t end);

}  // namespace dermis::bytes::proposals
