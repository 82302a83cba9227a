// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bytes/proposals/packet_fields.hpp"
#include "bytes/proposals/packet_search.hpp"
#include "bytes/proposals/smoothness.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {

/// Where the readings of a packet may stand.
struct ValueSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string type{};     ///< "u16le"
  std::size_t count = 0;  ///< Readings.
  double merit = 0.0;
  Readings readings{};  ///< Of the first packets.
};

/// The likeliest places and types of the readings between the bytes `begin` and `end` of each packet, the best first.
/// `counts`: how many there may be; empty: any that make a usual array.
[[nodiscard]] std::vector<ValueSpan> value_spans(const Packets& packets, std::span<const std::uint8_t> bytes,
                                                 std::size_t begin, std::size_t end,
                                                 const std::vector<PacketField>& fields,
                                                 const std::vector<std::size_t>& counts);

}  // namespace dermis::bytes::proposals
