// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/array_frames.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_frames.hpp"

namespace dermis::bytes::files {
namespace {

/// What changes slowly along the axis `slow`, and much along the others.
std::vector<float> smooth_along(const NumberArray& array, std::size_t slow) {
  std::vector<float> values(array.value_count());
  for (std::size_t k = 0; k < values.size(); ++k) {
    double value = 0.0;
    for (std::size_t axis = 0; axis < array.sizes.size(); ++axis) {
      const auto index = static_cast<double>(k / array.steps[axis] % array.sizes[axis]);
      value += axis == slow ? index : 100.0 * std::sin(index * static_cast<double>(7 + 4 * axis));
    }
    values[k] = static_cast<float>(value);
  }
  return values;
}

Result<FrameAxes> axes_in(const NumberArray& array, const std::string& words, std::optional<FrameShape> shape = {},
                          std::size_t times = 0, std::span<const float> values = {}) {
  return frame_axes(array, {"f.npz#touch", words, shape, times}, values);
}

std::string error_in(std::vector<std::size_t> sizes, const std::string& words, std::optional<FrameShape> shape = {}) {
  const auto axes = axes_in(NumberArray::last_fastest(std::move(sizes)), words, shape);
  return axes ? "no error" : axes.error().message;
}

/// Frame 0, as the values of an array that counts up from 0.
std::vector<float> first_frame(const NumberArray& array, const std::string& words) {
  std::vector<float> values(array.value_count());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<float>(k);
  const auto axes = axes_in(array, words);
  if (!axes) ADD_FAILURE() << axes.error().message;
  if (!axes) return {};
  RawFrame frame;
  EXPECT_TRUE(frames_of_array("f.npz", *axes, values, {{}, 10.0})->next(frame));
  return frame.counts;
}

TEST(ArrayFrames, stand_first_where_nothing_else_is_likely) {
  for (const std::vector<std::size_t>& sizes : {std::vector<std::size_t>{1000, 16, 16}, {3, 4, 5}, {100, 64, 160}}) {
    const auto axes = axes_in(NumberArray::last_fastest(sizes), "");
    ASSERT_TRUE(axes);
    EXPECT_EQ(axes->frames, sizes[0]);
    EXPECT_TRUE(axes->is_in_order());
  }
}

TEST(ArrayFrames, that_may_stand_last_are_asked_for_with_both_ways_to_say_it) {
  EXPECT_EQ(error_in({14, 6, 120}, ""),
            "is 14 x 6 x 120, which can be read in two ways: 14 frames of 6x120, as 'f.npz#touch[frames, rows, cols]', "
            "or 120 frames of 14x6, as 'f.npz#touch[rows, cols, frames]'");
  const NumberArray array = NumberArray::last_fastest({20, 16, 24});  // the sizes alone say nothing
  EXPECT_TRUE(needs_values(array, {"f"}));
  EXPECT_FALSE(axes_in(array, "", {}, 0, smooth_along(array, 2)));
  EXPECT_TRUE(axes_in(array, "", {}, 0, smooth_along(array, 0)));
  EXPECT_TRUE(axes_in(array, "", {}, 0, std::vector<float>(array.value_count(), 7.0F)));
  EXPECT_FALSE(needs_values(NumberArray::last_fastest({100, 16, 16}), {"f"}));
}

TEST(ArrayFrames, that_may_stand_between_rows_and_columns_are_asked_for) {
  const NumberArray array = NumberArray::last_fastest({4, 150, 16});
  EXPECT_TRUE(needs_values(array, {"f"}));
  EXPECT_EQ(axes_in(array, "", {}, 0, smooth_along(array, 1)).error().message,
            "is 4 x 150 x 16, which can be read in two ways: 4 frames of 150x16, as 'f.npz#touch[frames, rows, cols]', "
            "or 150 frames of 4x16, as 'f.npz#touch[rows, frames, cols]'");
  EXPECT_EQ(axes_in(array, "", {}, 0, smooth_along(array, 0))->frames, 4U);
  EXPECT_EQ(axes_in(array, "", FrameShape{4, 16})->frames, 150U);
}

TEST(ArrayFrames, long_arrays_whose_first_axis_is_clearly_the_time_are_not_asked_for) {
  const NumberArray array = NumberArray::last_fastest({10, 8, 32});
  EXPECT_TRUE(axes_in(array, "", {}, 0, smooth_along(array, 0)));
  EXPECT_FALSE(axes_in(array, "", {}, 0, smooth_along(array, 2)));
}

TEST(ArrayFrames, are_told_by_the_words_the_shape_or_the_times) {
  const NumberArray array = NumberArray::last_fastest({14, 6, 120});
  EXPECT_EQ(axes_in(array, "rows, cols, frames")->frames, 120U);
  EXPECT_EQ(axes_in(array, "frames, rows, cols")->frames, 14U);
  EXPECT_EQ(axes_in(array, ":, :, frames")->shape, (FrameShape{14, 6}));
  EXPECT_EQ(axes_in(array, "cols, rows, frames")->shape, (FrameShape{6, 14}));
  EXPECT_EQ(axes_in(array, "rows, frames, cols")->frames, 6U);
  EXPECT_EQ(axes_in(array, "", FrameShape{14, 6})->frames, 120U);
  EXPECT_EQ(axes_in(array, "", FrameShape{6, 120})->frames, 14U);
  EXPECT_EQ(axes_in(array, "", {}, 120)->frames, 120U);
  EXPECT_EQ(axes_in(array, "", {}, 14)->frames, 14U);
  EXPECT_EQ(axes_in(NumberArray::last_fastest({14, 6, 5000}), "")->frames, 5000U);
}

TEST(ArrayFrames, are_taken_out_of_four_axes_as_numpy_does) {
  const NumberArray array = NumberArray::last_fastest({5, 2, 3, 4});
  EXPECT_EQ(first_frame(array, "..., 2"), (std::vector<float>{2, 6, 10, 14, 18, 22}));
  EXPECT_EQ(first_frame(array, "0"), (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(first_frame(array, ":, -1"), (std::vector<float>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
  EXPECT_EQ(first_frame(array, "rows, 0, cols, frames"), (first_frame(array, "rows, 0, :, frames")));
  EXPECT_EQ(first_frame(NumberArray::last_fastest({3, 1, 1, 2}), ""), (std::vector<float>{0, 1}));
  EXPECT_EQ(error_in({5, 2, 3, 4}, ""),
            "is 5 x 2 x 3 x 4; take three of its axes, as 'f.npz#touch[:, 0]' or 'f.npz#touch[..., 2]'");
  EXPECT_EQ(error_in({5, 2, 3, 4}, "..., 4"), "is 5 x 2 x 3 x 4; [..., 4] has no '4'");
  EXPECT_EQ(error_in({5, 2, 3, 4}, "0, 0, 0"), "is 5 x 2 x 3 x 4; [0, 0, 0] leaves 1 axes, not three");
  EXPECT_EQ(error_in({5, 2, 3}, "0, 0, 0, 0"), "is 5 x 2 x 3; [0, 0, 0, 0] has not so many axes");
  EXPECT_EQ(error_in({5, 2, 3}, "frames, frames, rows"),
            "is 5 x 2 x 3; [frames, frames, rows] must name three axes frames, rows and cols, each once");
  EXPECT_EQ(error_in({5, 2, 3}, "frame, rows, cols"), "is 5 x 2 x 3; [frame, rows, cols] has no 'frame'");
}

TEST(ArrayFrames, of_two_axes_need_the_shape) {
  const NumberArray array = NumberArray::last_fastest({7, 6});
  EXPECT_EQ(axes_in(array, "", FrameShape{2, 3})->frames, 7U);
  EXPECT_EQ(axes_in(NumberArray::last_fastest({6, 70}), "", FrameShape{2, 3})->frames, 70U);
  EXPECT_EQ(axes_in(array, "", FrameShape{7, 6})->frames, 1U);
  EXPECT_EQ(error_in({7, 6}, ""), "has frames of 6 numbers; say how many rows and cols");
  EXPECT_EQ(error_in({7}, ""), "has 1 dimensions; frames x rows x cols is expected");
}

TEST(ArrayFrames, of_fortran_stand_last_in_memory) {
  const NumberArray array = NumberArray::first_fastest({2, 3, 4});
  EXPECT_EQ(first_frame(array, "rows, cols, frames"), (std::vector<float>{0, 2, 4, 1, 3, 5}));
  EXPECT_FALSE(axes_in(array, "frames, rows, cols")->is_in_order());
}

TEST(ArrayFrames, a_choice_is_a_name_and_axes) {
  EXPECT_EQ(array_choice("touch[..., 2]").name, "touch");
  EXPECT_EQ(array_choice("touch[..., 2]").axes, "..., 2");
  EXPECT_EQ(array_choice("[0]").name, "");
  EXPECT_EQ(array_choice("touch").axes, "");
}

TEST(ArrayFrames, times_say_their_unit_or_are_seconds_or_are_refused) {
  EXPECT_EQ(*seconds_of({0.0, 0.025}, 0.0), (std::vector<double>{0.0, 0.025}));
  EXPECT_DOUBLE_EQ(seconds_of({1.7e9, 1.7e9 + 0.5}, 0.0)->back(), 1.7e9 + 0.5);
  EXPECT_NEAR(seconds_of({1.7e12, 1.7e12 + 25}, 0.0)->back(), 1.7e9 + 0.025, 1e-6);
  EXPECT_NEAR(seconds_of({1.7e18, 1.7e18 + 25e6}, 0.0)->back(), 1.7e9 + 0.025, 1e-6);
  EXPECT_DOUBLE_EQ(seconds_of({0.0, 5e6}, 1e-9)->back(), 0.005);
  EXPECT_DOUBLE_EQ(seconds_of({0.0, 5.0}, 1.0)->back(), 5.0);
  EXPECT_FALSE(seconds_of({0.0, 25.0, 50.0}, 0.0));
}

}  // namespace
}  // namespace dermis::bytes::files
