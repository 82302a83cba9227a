// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/layouts/decoder.hpp"

namespace dermis::fuzz {

using dermis::bytes::layouts::Decoder;
using dermis::bytes::layouts::DecoderCounts;
using Bytes = std::span<const std::uint8_t>;

inline void require(bool is_so) {
  if (!is_so) std::abort();
}

/// All that a decoder gives, readings bit by bit.
struct Record {
  std::vector<std::uint64_t> frames;
  DecoderCounts counts;

  bool operator==(const Record&) const = default;
};

inline void take_frames(Decoder& decoder, std::uint64_t pushed, Record& record) {
  RawFrame frame;
  while (decoder.next(frame)) {
    const std::optional<FrameShape> shape = decoder.shape();
    require(shape && shape->taxel_count() == frame.counts.size() && !frame.counts.empty());
    require(shape->rows <= 1024 && shape->cols <= 1024);
    require(decoder.frame_end() <= pushed && (!frame.supply_v || *frame.supply_v > 0.0));
    record.frames.push_back(decoder.frame_end());
    record.frames.push_back(frame.acquisition.sequence.value_or(0));
    record.frames.push_back(static_cast<std::uint64_t>(frame.acquisition.device_time.value_or(Nanos{}).count()));
    record.frames.push_back(frame.acquisition.lost_before);
    record.frames.push_back(frame.acquisition.held_taxels);
    record.frames.push_back(std::bit_cast<std::uint64_t>(frame.temperature_celsius.value_or(0.0)));
    record.frames.push_back(std::bit_cast<std::uint64_t>(frame.supply_v.value_or(0.0)));
    for (const float count : frame.counts) record.frames.push_back(std::bit_cast<std::uint32_t>(count));
  }
  record.counts = decoder.counts();
}

inline Record decode(Decoder& decoder, Bytes bytes, std::size_t interrupted_at, std::size_t piece) {
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

}  // namespace dermis::fuzz
