// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/frame_source.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace dermis {
namespace {

class TwoFrames final : public FrameSource {
 public:
  Result<bool> next(RawFrame& frame) override {
    if (count_ == 2) return false;
    frame.counts.assign(1, static_cast<float>(count_++));
    return true;
  }
  std::optional<FrameShape> shape() const override { return FrameShape{1, 1}; }

 private:
  int count_ = 0;
};

TEST(FrameSource, is_read_to_its_end_through_the_interface) {
  const std::unique_ptr<FrameSource> source = std::make_unique<TwoFrames>();
  RawFrame frame;
  std::vector<float> counts;
  while (true) {
    const Result<bool> got_frame = source->next(frame);
    ASSERT_TRUE(got_frame);
    if (!*got_frame) break;
    counts.push_back(frame.counts[0]);
  }
  EXPECT_EQ(counts, (std::vector<float>{0.0F, 1.0F}));
}

TEST(FrameSource, cannot_be_waited_for_beside_others_unless_it_says_so) {
  const std::unique_ptr<FrameSource> source = std::make_unique<TwoFrames>();
  EXPECT_FALSE(source->readiness());
}

TEST(FrameSource, is_a_file_of_numbered_frames_unless_it_says_otherwise) {
  const std::unique_ptr<FrameSource> source = std::make_unique<TwoFrames>();
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->place(), "");
  EXPECT_EQ(source->statistics(), SourceStatistics{});
}

}  // namespace
}  // namespace dermis
