// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/window_decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace dermis::bytes::layouts {
namespace {

/// Frames are 'F', a reading and ';'. The letter 'X' in the place of the end marks a damaged one.
class ThreeBytes final : public WindowDecoder {
 public:
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return FrameShape{1, 1}; }

 private:
  Verdict judge(std::span<const std::uint8_t> bytes, bool, RawFrame& frame) override {
    if (bytes[0] != 'F') return {Verdict::Kind::noise, 1};
    if (bytes.size() < 3) return {};
    if (bytes[2] != ';') return {Verdict::Kind::damaged, 3};
    frame.counts = {static_cast<float>(bytes[1] - '0')};
    return {Verdict::Kind::frame, 3};
  }
};

std::vector<float> readings_of(WindowDecoder& decoder, std::string_view text, std::size_t piece) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  std::vector<float> readings;
  RawFrame frame;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
    while (decoder.next(frame)) readings.push_back(frame.counts[0]);
  }
  return readings;
}

TEST(WindowDecoder, frames_and_counts_do_not_depend_on_the_pieces) {
  for (const std::size_t piece : {1U, 2U, 3U, 100U}) {
    ThreeBytes decoder;
    EXPECT_EQ(readings_of(decoder, "abF1;F2XF3;F", piece), (std::vector<float>{1, 3}));
    EXPECT_EQ(decoder.counts(), (DecoderCounts{.frames = 2, .damaged_frames = 1, .skipped_bytes = 5}));
    EXPECT_EQ(decoder.frame_end(), 11U);
  }
}

TEST(WindowDecoder, what_is_left_at_the_end_belongs_to_no_frame) {
  ThreeBytes decoder;
  static_cast<void>(readings_of(decoder, "F1;F", 4));
  decoder.finish();
  RawFrame frame;
  EXPECT_FALSE(decoder.next(frame));
  EXPECT_EQ(decoder.counts().skipped_bytes, 1U);
}

}  // namespace
}  // namespace dermis::bytes::layouts
