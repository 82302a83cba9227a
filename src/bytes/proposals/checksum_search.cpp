// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/checksum_search.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/draft.hpp"
#include "bytes/proposals/trial.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kPackets = 8;  // tried
constexpr std::size_t kLongestTrailer = 4;

struct Kind {
  const char* name = "";
  std::size_t size = 0;
  const char* options = "";
};
constexpr std::array kKinds = {
    Kind{"sum8", 1},
    Kind{"xor8", 1},
    Kind{"sum8", 1, " negated"},
    Kind{"sum8", 1, " xorout=FF"},
    Kind{"crc8", 1},
    Kind{"crc8-maxim", 1},
    Kind{"sum16", 2},
    Kind{"crc16", 2},
    Kind{"crc16-xmodem", 2},
    Kind{"crc16-modbus", 2},
    Kind{"crc16-kermit", 2},
    Kind{"crc16", 2, " init=1D0F"},
    Kind{"sum32", 4},
    Kind{"crc32", 4},
};

/// Packets whose checksum is this one are read; of others none is.
std::string toml_with(const Packets& packets, std::size_t at, const std::string& checksum, std::size_t size) {
  Draft draft{.arrays = {{"", {1, 1}}}};
  const std::size_t mark = packets.escape.empty() ? packets.mark_size : 0;
  const Bytes& first = packets.packets.front();
  if (mark > 0) draft.packet.push_back(layouts::hexadecimal(std::span(first).first(mark)));
  draft.packet.emplace_back("values u8 x1");
  if (at > mark + 1) draft.packet.push_back("skip " + std::to_string(at - mark - 1));
  draft.packet.push_back(checksum);
  if (at + size < packets.size) draft.packet.push_back("skip " + std::to_string(packets.size - at - size));
  if (!packets.escape.empty()) draft.keys.emplace_back("escape", files::quoted_toml(packets.escape));
  return toml_of(draft);
}

}  // namespace

std::span<const std::uint8_t> first_packets(const Packets& packets, std::span<const std::uint8_t> bytes,
                                            std::size_t count) {
  if (packets.places.empty()) return bytes.first(std::min(bytes.size(), (2 * packets.size + 2) * count));
  return bytes.subspan(packets.places.front(), std::min(bytes.size() - packets.places.front(), packets.size * count));
}

std::optional<FoundChecksum> checksum_of(const Packets& packets, std::span<const std::uint8_t> bytes) {
  const std::span<const std::uint8_t> sample = first_packets(packets, bytes, kPackets);
  const std::size_t needed = std::min(kPackets, packets.packets.size()) * 3 / 4;
  std::size_t trailer = 0;
  for (; trailer <= kLongestTrailer && trailer + 2 < packets.size; ++trailer) {
    for (const Kind& kind : kKinds) {
      if (packets.size < packets.mark_size + trailer + kind.size + 2) continue;
      const std::size_t at = packets.size - trailer - kind.size;
      if (is_constant(packets, at) && is_constant(packets, at + kind.size - 1)) continue;
      std::vector<std::size_t> begins = {0, 1, 2, 3, 4};
      std::erase_if(begins, [&](std::size_t from) { return from > packets.mark_size && from > 1; });
      for (const char* order : {"le", "be"}) {
        if (kind.size == 1 && order[0] == 'b') continue;
        for (const std::size_t from : begins) {
          const std::string entry = std::string("checksum ") + kind.name + (kind.size > 1 ? order : "") + kind.options +
                                    (from > 0 ? " from=" + std::to_string(from) : "");
          const std::optional<Trial> trial = try_layout(toml_with(packets, at, entry, kind.size), sample);
          if (trial && trial->frames >= std::max<std::size_t>(needed, 2)) return FoundChecksum{at, kind.size, entry};
        }
      }
    }
    if (!is_constant(packets, packets.size - 1 - trailer)) break;
  }
  return std::nullopt;
}

}  // namespace dermis::bytes::proposals
