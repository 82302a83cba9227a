// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "dermis/bytes/devices/protocol.hpp"

namespace dermis::bytes::devices {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

inline std::unique_ptr<Decoder> decoder_for(const ProtocolOptions& options) {
  Result<std::unique_ptr<Decoder>> decoder = make_decoder(options);
  EXPECT_TRUE(decoder) << (decoder ? "" : decoder.error().message);
  return std::move(decoder).value();
}

/// Pushes `bytes` in pieces of `piece` and returns the frames; does not end the stream.
inline std::vector<RawFrame> push_all(Decoder& decoder, std::span<const std::uint8_t> bytes,
                                      std::size_t piece = Decoder::kMaxPush) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.push(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    while (decoder.next(frame)) frames.push_back(frame);
  }
  return frames;
}

inline std::vector<RawFrame> finish(Decoder& decoder) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  decoder.finish();
  while (decoder.next(frame)) frames.push_back(frame);
  return frames;
}

/// All frames of a stream that ends.
inline std::vector<RawFrame> decode_all(Decoder& decoder, std::span<const std::uint8_t> bytes,
                                        std::size_t piece = Decoder::kMaxPush) {
  std::vector<RawFrame> frames = push_all(decoder, bytes, piece);
  const std::vector<RawFrame> last = finish(decoder);
  frames.insert(frames.end(), last.begin(), last.end());
  return frames;
}

inline std::vector<std::vector<float>> counts_of(const std::vector<RawFrame>& frames) {
  std::vector<std::vector<float>> counts;
  for (const RawFrame& frame : frames) counts.push_back(frame.counts);
  return counts;
}

}  // namespace dermis::bytes::devices
