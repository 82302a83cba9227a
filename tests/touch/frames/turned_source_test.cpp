// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/turned_source.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

/// Frames of 2x3 with the numbers of their taxels; each is a second after the one before.
class NumberedFrames final : public FrameSource {
 public:
  explicit NumberedFrames(std::size_t frames) : left_(frames) {}

  Result<bool> next(RawFrame& frame) override {
    if (left_ == 0) return false;
    --left_;
    shape_ = FrameShape{2, 3};
    time_ += std::chrono::seconds(1);
    frame.time = time_;
    frame.supply_v = 5.0;
    frame.acquisition.sequence = left_;
    frame.counts = {0, 1, 2, 3, 4, 5};
    return true;
  }
  [[nodiscard]] std::optional<Readiness> readiness() const override {
    return Readiness{.due = std::chrono::seconds(5)};
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.frames = 7;
    return statistics;
  }
  [[nodiscard]] bool is_live() const override { return true; }
  [[nodiscard]] std::string place() const override { return "here"; }

 private:
  std::size_t left_;
  Nanos time_{};
  std::optional<FrameShape> shape_;
};

TEST(TurnedSource, gives_the_frames_turned_and_everything_else_as_it_was) {
  const auto source = turned_source(std::make_unique<NumberedFrames>(2), {.transpose = true, .flip_cols = true}, "mat");
  EXPECT_FALSE(source->shape()) << "known with the first frame";
  RawFrame frame;
  for (int second = 1; second <= 2; ++second) {
    ASSERT_TRUE(*source->next(frame));
    EXPECT_EQ(frame.counts, (std::vector<float>{3, 0, 4, 1, 5, 2}));
    EXPECT_EQ(frame.time, std::chrono::seconds(second));
    EXPECT_EQ(frame.supply_v, 5.0);
    EXPECT_EQ(frame.acquisition.sequence, 2U - static_cast<unsigned>(second));
    EXPECT_EQ(source->shape(), (FrameShape{3, 2}));
  }
  EXPECT_FALSE(*source->next(frame));
  EXPECT_EQ(source->statistics().frames, 7U);
  EXPECT_TRUE(source->is_live());
  EXPECT_EQ(source->place(), "here");
}

TEST(TurnedSource, turns_the_frames_that_it_is_polled_for) {
  const auto source = turned_source(std::make_unique<NumberedFrames>(1), {.transpose = true, .flip_cols = true}, "mat");
  RawFrame frame;
  EXPECT_EQ(source->readiness()->due, std::chrono::seconds(5));
  EXPECT_EQ(*source->poll(frame), Polled::frame);
  EXPECT_EQ(frame.counts, (std::vector<float>{3, 0, 4, 1, 5, 2}));
  EXPECT_EQ(*source->poll(frame), Polled::end);
}

TEST(TurnedSource, is_the_source_itself_where_nothing_is_turned) {
  auto frames = std::make_unique<NumberedFrames>(1);
  const FrameSource* const same = frames.get();
  EXPECT_EQ(turned_source(std::move(frames), {}, "mat").get(), same);
}

TEST(TurnedSource, says_where_an_order_does_not_fit_the_frames) {
  RawFrame frame;
  const Result<bool> more = turned_source(std::make_unique<NumberedFrames>(1), {.skip_columns = 3}, "mat")->next(frame);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().message, "'mat': skip_columns: leaves none of 3 columns");
}

}  // namespace
}  // namespace dermis
