// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/trial.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostKept = 24;  // frames

Trial decode(const std::shared_ptr<const layouts::Layout>& layout, std::size_t array,
             std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<layouts::Decoder> decoder = layouts::make_decoder(layout, array, false);
  Trial trial;
  RawFrame frame;
  const auto drain = [&] {
    while (decoder->next(frame)) {
      if (trial.readings.size() < kMostKept) trial.readings.push_back(frame.counts);
    }
  };
  for (std::size_t at = 0; at < bytes.size(); at += layouts::Decoder::kMaxPush) {
    decoder->push(bytes.subspan(at, std::min(layouts::Decoder::kMaxPush, bytes.size() - at)));
    drain();
  }
  decoder->finish();
  drain();
  trial.frames = static_cast<std::size_t>(decoder->counts().frames);
  trial.left = decoder->counts().skipped_bytes;
  trial.lost = decoder->counts().lost_frames;
  return trial;
}

bool is_empty(const Readings& readings) {
  return std::all_of(readings.begin(), readings.end(), [](const std::vector<float>& frame) {
    return std::all_of(frame.begin(), frame.end(), [](float value) { return value == 0.0F; });
  });
}

}  // namespace

std::optional<Trial> try_layout(const std::string& toml, std::span<const std::uint8_t> bytes) {
  Result<layouts::Layout> layout = layouts::layout_from_toml(toml, "");
  if (!layout) return std::nullopt;
  const auto shared = std::make_shared<const layouts::Layout>(*std::move(layout));
  Trial trial = decode(shared, 0, bytes);
  trial.has_empty_array = shared->arrays.size() > 1 && is_empty(trial.readings);
  for (std::size_t array = 1; array < shared->arrays.size(); ++array) {
    const Trial other = decode(shared, array, bytes);
    trial.frames = std::min(trial.frames, other.frames);
    trial.has_empty_array = trial.has_empty_array || is_empty(other.readings);
    trial.left = std::max(trial.left, other.left);
  }
  return trial;
}

}  // namespace dermis::bytes::proposals
