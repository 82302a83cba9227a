// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/view_pictures.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "support/force_mat.hpp"

namespace dermis::views {
namespace {

using support::error_of;
using support::kPressed;
using support::MatFiles;
using support::pressed;

constexpr std::chrono::milliseconds kMs{1};

/// A frame every 10 ms, whose pressed taxel reads its number.
class Counting {
 public:
  explicit Counting(std::size_t frames) {
    std::vector<float> readings(frames);
    for (std::size_t i = 0; i < frames; ++i) readings[i] = static_cast<float>(i);
    path_ = mat_.write("frames.csv", pressed(readings));
  }

  [[nodiscard]] std::unique_ptr<ArrayView> view(bool with_model = false) const {
    Result<std::unique_ptr<ArrayView>> view = ArrayView::open(path_, with_model ? mat_.model() : "");
    EXPECT_TRUE(view) << error_of(view);
    return *std::move(view);
  }
  [[nodiscard]] Result<std::vector<out::report::FramePicture>> drawn(const PictureRange& range) const {
    return draw_pictures(*view(), range);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  MatFiles mat_;
  std::string path_;
};

std::vector<double> numbers_of(const Result<std::vector<out::report::FramePicture>>& pictures) {
  std::vector<double> numbers;
  EXPECT_TRUE(pictures) << error_of(pictures);
  for (const out::report::FramePicture& picture : *pictures) numbers.push_back(picture.values[kPressed]);
  return numbers;
}

TEST(DrawPictures, of_one_frame_by_its_number_or_its_time) {
  const Counting counting(20);
  EXPECT_EQ(numbers_of(counting.drawn({})), (std::vector<double>{0.0}));
  EXPECT_EQ(numbers_of(counting.drawn({.number = 7})), (std::vector<double>{7.0}));
  EXPECT_EQ(numbers_of(counting.drawn({.from = 75 * kMs})), (std::vector<double>{8.0}));
}

TEST(DrawPictures, of_a_film_every_40_ms_until_its_end_or_that_of_the_source) {
  const Counting counting(20);
  EXPECT_EQ(numbers_of(counting.drawn({.from = 40 * kMs, .to = 160 * kMs})), (std::vector<double>{4.0, 7.0, 11.0}));
  EXPECT_EQ(numbers_of(counting.drawn({.from = 120 * kMs, .to = 1000 * kMs})).size(), 2U);
}

TEST(DrawPictures, says_when_the_frame_was_and_what_touched) {
  const Counting counting(20);
  const auto view = counting.view(true);
  const auto pictures = draw_pictures(*view, {.number = 6});
  ASSERT_TRUE(pictures);
  EXPECT_EQ(pictures->front().title, "mat");
  EXPECT_EQ(pictures->front().subtitle, "0.060 s, 1 contact, 6 N");
  EXPECT_EQ(pictures->front().unit, "N");
  EXPECT_EQ(pictures->front().contacts.size(), 1U);
  EXPECT_EQ(pictures->front().row_pitch_m, 0.004);
}

TEST(DrawPictures, have_one_scale) {
  const Counting counting(20);
  const PictureRange range{.from = 0 * kMs, .to = 160 * kMs};
  const auto view = counting.view(true);
  const auto pictures = draw_pictures(*view, range);
  ASSERT_TRUE(pictures);
  for (const out::report::FramePicture& picture : *pictures) EXPECT_EQ(picture.high, 20.0);
  const auto again = counting.view(true);
  EXPECT_EQ(draw_pictures(*again, range, 3.0)->back().high, 3.0);
}

TEST(DrawPictures, fails_where_there_is_nothing_to_draw_or_too_much) {
  const Counting counting(20);
  EXPECT_EQ(error_of(counting.drawn({.number = 20})),
            counting.path() + ": has 20 frames, which end before the one that is asked for");
  const std::atomic<bool> stop = true;
  EXPECT_EQ(error_of(draw_pictures(*counting.view(), {}, {}, &stop)), "interrupted");
  const MatFiles mat;
  std::vector<RawFrame> two = pressed({1.0F, 2.0F});
  two[1].time += std::chrono::seconds(61);
  const auto view = ArrayView::open(mat.write("long.csv", two), "");
  ASSERT_TRUE(view);
  EXPECT_EQ(error_of(draw_pictures(**view, {.to = std::chrono::seconds(61)})), "to: at most 60 s are drawn");
}

}  // namespace
}  // namespace dermis::views
