// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bytes/proposals/packet_search.hpp"

namespace dermis::bytes::proposals {

struct FoundChecksum {
  std::size_t at = 0;
  std::size_t size = 0;
  std::string entry;  ///< "checksum crc16-modbusle"
};

/// The known checksum that is right in all of the first packets. `bytes`: the stream.
[[nodiscard]] std::optional<FoundChecksum> checksum_of(const Packets& packets, std::span<const std::uint8_t> bytes);

/// The bytes of the first packets, as they stand in the stream.
[[nodiscard]] std::span<const std::uint8_t> first_packets(const Packets& packets, std::span<const std::uint8_t> bytes,
                                                          std::size_t count);

}  // namespace dermis::bytes::proposals
