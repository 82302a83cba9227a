// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/segment_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kSide = 20;

std::vector<double> block_of(const Layout& layout, const std::vector<float>& frame, Block wanted) {
  SegmentFeatures features(layout, layout, false, 1);
  const std::span<const double> all = features.compute({frame, {}});
  for (const BlockColumns& block : feature_columns(layout, false).blocks) {
    if (block.block != wanted) continue;
    const std::span<const double> values = all.subspan(block.begin, block.size);
    return {values.begin(), values.end()};
  }
  ADD_FAILURE() << "no such block";
  return {};
}

std::vector<float> touch(double row, double col, double along_rows, double along_cols) {
  std::vector<float> frame(kSide * kSide);
  support::press(frame, kSide, kSide, 1.0, {row, col, along_rows, along_cols, 1000.0});
  return frame;
}

std::vector<float> turned(const std::vector<float>& frame) {
  std::vector<float> result(frame.size());
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t col = 0; col < kSide; ++col) result[col * kSide + (kSide - 1 - row)] = frame[row * kSide + col];
  }
  return result;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Features, of_form_do_not_see_where_a_contact_is) {
  const Layout layout = support::one_array(kSide, kSide);
  for (const Block block : {Block::form, Block::polar}) {
    const std::vector<double> here = block_of(layout, touch(9.0, 9.0, 1.0, 1.8), block);
    const std::vector<double> there = block_of(layout, touch(11.0, 10.0, 1.0, 1.8), block);
    EXPECT_LT(largest_difference(here, there), 1e-3);
  }
}

TEST(Features, of_form_do_not_see_which_way_a_contact_is_turned) {
  const Layout layout = support::one_array(kSide, kSide);
  const std::vector<float> frame = touch(9.4, 10.2, 1.0, 1.8);
  for (const Block block : {Block::form, Block::polar}) {
    EXPECT_LT(largest_difference(block_of(layout, frame, block), block_of(layout, turned(frame), block)), 1e-6);
  }
}

TEST(Features, of_form_see_what_form_it_is) {
  const Layout layout = support::one_array(kSide, kSide);
  for (const Block block : {Block::form, Block::polar}) {
    const std::vector<double> narrow = block_of(layout, touch(10.0, 10.0, 1.0, 1.0), block);
    const std::vector<double> wide = block_of(layout, touch(10.0, 10.0, 1.0, 1.8), block);
    EXPECT_GT(largest_difference(narrow, wide), 0.05);
  }
}

TEST(Features, of_pose_tell_where_a_contact_is_and_how_it_lies) {
  const Layout layout = support::one_array(kSide, kSide);
  const std::vector<double> along_cols = block_of(layout, touch(5.5, 10.5, 1.0, 2.0), Block::pose);
  EXPECT_NEAR(along_cols[0], 5.0 / kSide, 1e-3);
  EXPECT_NEAR(along_cols[1], 10.0 / kSide, 1e-3);
  EXPECT_GT(along_cols[2], 0.3);
  EXPECT_NEAR(along_cols[3], 0.0, 1e-6);
  const std::vector<double> along_rows = block_of(layout, touch(5.5, 10.5, 2.0, 1.0), Block::pose);
  EXPECT_LT(along_rows[2], -0.3);
}

TEST(Features, of_a_frame_without_load_are_finite) {
  Layout layout = support::one_array(5, 4);
  layout.arrays.push_back(layout.arrays.front());
  layout.extras = 2;
  const std::vector<float> frames(std::size_t{3} * 20);
  const std::vector<float> extras{1, 2, 3, 4, 7, 9};
  for (const bool moving : {false, true}) {
    SegmentFeatures features(layout, layout, moving, 3);
    const std::span<const double> values = features.compute({frames, extras});
    EXPECT_EQ(values.size(), feature_columns(layout, moving).count);
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
    for (const BlockColumns& block : feature_columns(layout, moving).blocks) {
      if (block.block != Block::extra) continue;
      EXPECT_EQ(values[block.begin], 7.0);
      EXPECT_EQ(values[block.begin + 3], 7.0);
    }
  }
}

TEST(Features, of_a_single_taxel_are_finite) {
  const Layout layout = support::one_array(1, 1);
  const std::vector<float> frames{1.0F, 2.0F};
  SegmentFeatures features(layout, layout, true, 2);
  const std::span<const double> values = features.compute({frames, {}});
  EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
}

TEST(Features, take_a_reading_that_is_no_load_as_0_between_frames_too) {
  const Layout examples = support::one_array(kSide, kSide, 4.0, 100.0);
  const Layout source = support::one_array(kSide, kSide, 4.0, 150.0);
  SegmentFeatures features(examples, source, true, 6);
  std::vector<float> frames;
  for (int frame = 0; frame < 6; ++frame) {
    const std::vector<float> readings = touch(9.0, 9.0, 1.0, 1.8);
    frames.insert(frames.end(), readings.begin(), readings.end());
  }
  float& reading = frames[2 * kSide * kSide + 9 * kSide + 9];
  reading = 0.0F;
  const std::span<const double> all = features.compute({frames, {}});
  const std::vector<double> expected(all.begin(), all.end());
  for (const float none : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -500.0F}) {
    reading = none;
    EXPECT_TRUE(std::ranges::equal(features.compute({frames, {}}), expected)) << none;
  }
}

TEST(Features, of_the_expert_all_are_those_of_the_recipe) {
  Layout layout;
  layout.arrays = {{"finger1", 13, 6, 0}, {"finger3", 13, 6, 78}};
  layout.readings = 156;
  layout.extras = 7;
  std::vector<std::size_t> sizes;
  for (const ExpertColumns& expert : expert_columns(layout, true)) sizes.push_back(expert.columns.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{296, 206, 222, 246, 24}));  // place, form, motion, all, state
}

TEST(Features, of_taxels_are_those_of_small_arrays) {
  EXPECT_TRUE(tells_of_taxels(support::one_array(12, 12)));
  EXPECT_FALSE(tells_of_taxels(support::one_array(12, 13)));
  const std::vector<ExpertColumns> experts = expert_columns(support::one_array(5, 5), true);
  std::vector<std::string> names;
  for (const ExpertColumns& expert : experts) names.push_back(expert.name);
  EXPECT_EQ(names, (std::vector<std::string>{"place", "form", "motion", "all", "taxels", "pattern", "course"}));
  EXPECT_EQ(experts[4].columns.size(), 100U);
  EXPECT_EQ(experts[5].columns.size(), 25U);
  EXPECT_EQ(experts[6].columns.size(), 75U);
}

std::vector<double> taxel_features(const Layout& examples, const Layout& source, const std::vector<float>& frames,
                                   bool moving) {
  SegmentFeatures features(examples, source, moving, frames.size() / source.readings);
  const std::span<const double> all = features.compute({frames, {}});
  std::vector<double> values;
  for (const BlockColumns& block : feature_columns(examples, moving).blocks) {
    if (block.block != Block::pattern && block.block != Block::course) continue;
    const std::span<const double> part = all.subspan(block.begin, block.size);
    values.insert(values.end(), part.begin(), part.end());
  }
  return values;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-6) << i;
}

TEST(Features, of_taxels_are_roots_of_what_they_read) {
  Layout layout = support::one_array(1, 2);
  layout.arrays.push_back({"second", 1, 1, 2});
  layout.readings = 3;
  // Held: the second frame. Means 5, 2, 2; deviations 4, 2, 2; changes 8, 4, 4.
  expect_near(taxel_features(layout, layout, {1, 0, 0, 9, 4, 4}, true),
              {3 / std::sqrt(17.0), 2 / std::sqrt(17.0), 2 / std::sqrt(17.0), std::sqrt(5.0), std::sqrt(2.0),
               std::sqrt(2.0), 2, std::sqrt(2.0), std::sqrt(2.0), std::sqrt(8.0), 2, 2});
}

TEST(Features, of_taxels_of_another_size_are_shared_out_to_those_of_the_examples) {
  const Layout examples = support::one_array(1, 2, 4.0);
  const Layout source = support::one_array(1, 3, 4.0);
  // The middle reading belongs to both halves: 9 and 4 + 5 to the first, 16 and 5 to the second.
  expect_near(taxel_features(examples, source, {4, 10, 11}, false), {3.0 / 5.0, 4.0 / 5.0, 3, 4});
}

TEST(Regrid, keeps_the_sum_and_the_place) {
  const SensedArray fine{"skin", 24, 20, 0, 2.0, 2.0};
  const SensedArray coarse{"skin", 12, 10, 0, 4.0, 4.0};
  const Lattice lattice = common_lattice(coarse, fine);
  ASSERT_EQ(lattice.rows, 12U);
  ASSERT_EQ(lattice.cols, 10U);
  std::vector<float> frame(fine.taxel_count());
  support::press(frame, 24, 20, 0.5, {5.0, 4.0, 1.0, 1.0, 100.0});
  std::vector<float> expected(coarse.taxel_count());
  support::press(expected, 12, 10, 1.0, {5.0, 4.0, 1.0, 1.0, 100.0});
  std::vector<double> image(lattice.taxels());
  Regrid(fine, lattice).apply(frame, image);
  double sum = 0.0;
  double expected_sum = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    sum += image[i];
    expected_sum += static_cast<double>(expected[i]);
    EXPECT_NEAR(image[i], static_cast<double>(expected[i]), 4.0);
  }
  EXPECT_NEAR(sum, expected_sum, 0.01 * expected_sum);
}

TEST(Regrid, leaves_readings_of_a_pitch_that_is_not_known) {
  const SensedArray array{"skin", 2, 3, 0};
  const Lattice lattice = common_lattice(array, {"skin", 2, 3, 0, 4.0, 4.0});
  EXPECT_EQ(lattice.rows, 2U);
  EXPECT_EQ(lattice.cols, 3U);
  EXPECT_EQ(lattice.row_step, 1.0);
}

}  // namespace
}  // namespace dermis::learn::recognition
