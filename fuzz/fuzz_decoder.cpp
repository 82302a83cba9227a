// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// First byte: the protocol (4 bits), whether the shape is given, whether it is a small one, the other form of wiresens
// and stag and datagrams, and whether the stream is interrupted at its half. Second byte: how the bytes are cut. The
// rest: the bytes.
// Where the environment has DERMIS_FUZZ_PROTOCOL, the protocol is that one.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "dermis/acquisition/protocol.hpp"

namespace dermis::acquisition {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array kProtocols = {"dermis",   "flexitac", "m1616",        "pressure-mat", "wuji", "3dvitac",
                                   "wiresens", "stag",     "tactileglove", "csv",          "auto", "json"};

void require(bool is_so) {
  if (!is_so) std::abort();
}

ProtocolOptions options_of(std::uint8_t choice) {
  ProtocolOptions options;
  static const char* const named = std::getenv("DERMIS_FUZZ_PROTOCOL");
  options.name = named != nullptr ? named : kProtocols[(choice & 0x0FU) % kProtocols.size()];
  if ((choice & 0x10U) != 0) options.shape = (choice & 0x20U) != 0 ? FrameShape{2, 3} : FrameShape{16, 16};
  options.nodes_per_packet = (choice & 0x20U) != 0 ? 4 : 120;
  options.delimited = (choice & 0x40U) == 0;
  options.datagrams = (choice & 0x40U) != 0;
  options.bit_shift = (choice & 0x40U) == 0 ? 5 : 6;
  return options;
}

/// All that a decoder says, readings bit by bit.
struct Record {
  std::vector<std::uint64_t> said;
  DecoderCounts counts;

  bool operator==(const Record&) const = default;
};

void take_frames(Decoder& decoder, std::uint64_t pushed, Record& record) {
  RawFrame frame;
  while (decoder.next(frame)) {
    const std::optional<FrameShape> shape = decoder.shape();
    require(shape && shape->taxel_count() == frame.counts.size() && !frame.counts.empty());
    require(shape->rows <= 1024 && shape->cols <= 1024);
    require(decoder.frame_end() <= pushed && (!frame.supply_v || *frame.supply_v > 0.0));
    record.said.push_back(decoder.frame_end());
    record.said.push_back(frame.acquisition.sequence.value_or(0));
    record.said.push_back(static_cast<std::uint64_t>(frame.acquisition.device_time.value_or(Nanos{}).count()));
    record.said.push_back(frame.acquisition.lost_before);
    record.said.push_back(frame.acquisition.held_taxels);
    record.said.push_back(std::bit_cast<std::uint64_t>(frame.temperature_celsius.value_or(0.0)));
    record.said.push_back(std::bit_cast<std::uint64_t>(frame.supply_v.value_or(0.0)));
    for (const float count : frame.counts) record.said.push_back(std::bit_cast<std::uint32_t>(count));
  }
  record.counts = decoder.counts();
}

Record decode(Decoder& decoder, Bytes bytes, std::size_t interrupted_at, std::size_t piece) {
  Record record;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t limit = at < interrupted_at ? interrupted_at : bytes.size();
    const std::size_t size = std::min({piece, limit - at, Decoder::kMaxPush});
    decoder.push(bytes.subspan(at, size));
    at += size;
    take_frames(decoder, at, record);
    if (at != interrupted_at) continue;
    decoder.idle();
    take_frames(decoder, at, record);
    decoder.finish();
    take_frames(decoder, at, record);
  }
  decoder.finish();
  take_frames(decoder, at, record);
  require(record.counts.skipped_bytes <= bytes.size());
  return record;
}

}  // namespace
}  // namespace dermis::acquisition

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dermis::acquisition;
  if (size < 2) return 0;
  const ProtocolOptions options = options_of(data[0]);
  const auto whole = make_decoder(options);
  const auto cut = make_decoder(options);
  require(whole.has_value() == cut.has_value());
  if (!whole) return 0;
  const Bytes bytes(data + 2, size - 2);
  const std::size_t interrupted_at = (data[0] & 0x80U) != 0 ? bytes.size() / 2 : bytes.size();
  const std::size_t piece = 1 + data[1] * std::size_t{data[1]} / 16;
  require(decode(**whole, bytes, interrupted_at, bytes.size()) == decode(**cut, bytes, interrupted_at, piece));
  return 0;
}
