// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/press_finder.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "learn/arrangement/board.hpp"

namespace dermis::learn::arrangement {
namespace {

using testing::Board;
using testing::shuffled;

std::vector<int> channels_of(const std::vector<Press>& presses) {
  std::vector<int> channels;
  for (const Press& press : presses) channels.push_back(static_cast<int>(press.channel));
  return channels;
}

void expect_found(const Board& board) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<int> pressed = shuffled(board.channels, seed);
    EXPECT_EQ(channels_of(find_presses(board.frames(pressed, seed))), pressed) << "seed " << seed;
  }
}

TEST(PressFinder, finds_the_channel_of_each_press) {
  expect_found({});
}

TEST(PressFinder, finds_presses_that_lower_the_reading) {
  expect_found({.level = 3600.0, .press = -900.0});
}

TEST(PressFinder, follows_drift) {
  expect_found({.drift_per_s = 15.0});
  expect_found({.level = 2500.0, .drift_per_s = -20.0});
}

TEST(PressFinder, finds_presses_in_heavy_noise_and_crosstalk) {
  expect_found({.noise = 15.0, .crosstalk = 0.3, .neighbour = 0.7});
}

TEST(PressFinder, finds_presses_over_what_the_material_keeps) {
  expect_found({.memory = 0.3});
}

TEST(PressFinder, finds_presses_of_slow_and_of_fast_boards) {
  expect_found({.rate_hz = 10.0, .held_s = 0.8, .between_s = 0.8});
  expect_found({.channels = 9, .rate_hz = 800.0});
}

TEST(PressFinder, takes_what_all_channels_do_together_for_no_press) {
  expect_found({.together = 60.0});
}

TEST(PressFinder, finds_presses_of_a_board_that_rests_at_exactly_0) {
  expect_found({.level = 0.0, .noise = 0.0});
}

TEST(PressFinder, finds_presses_that_are_there_at_the_beginning_and_at_the_end) {
  Board board{.between_s = 0.6, .before_s = 0.0};
  const std::vector<int> pressed = shuffled(9);
  std::vector<RawFrame> frames = board.frames(pressed);
  frames.erase(frames.begin(), frames.begin() + 10);
  frames.resize(frames.size() - 45);
  EXPECT_EQ(channels_of(find_presses(frames)), pressed);
}

TEST(PressFinder, passes_over_a_channel_that_is_stuck_one_that_is_noisy_and_missing_readings) {
  const Board board;
  const std::vector<int> pressed = {3, 9, 12, 5, 16};
  std::vector<RawFrame> frames = board.frames(pressed);
  Random random(3);
  for (RawFrame& frame : frames) {
    frame.counts[0] = 1023.0F;
    frame.counts[1] += static_cast<float>(60.0 * random.normal());
    frame.counts[2] = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(channels_of(find_presses(frames)), pressed);
}

TEST(PressFinder, finds_the_press_of_a_noisy_channel_beside_quiet_ones) {
  const Board board;
  const std::vector<int> pressed = {3, 8, 12};
  std::vector<RawFrame> frames = board.frames(pressed);
  Random random(3);
  for (RawFrame& frame : frames) frame.counts[8] += static_cast<float>(25.0 * random.normal());
  EXPECT_EQ(channels_of(find_presses(frames)), pressed);
}

TEST(PressFinder, passes_over_single_frames_that_jump) {
  const Board board;
  const std::vector<int> pressed = {3, 9, 12};
  std::vector<RawFrame> frames = board.frames(pressed);
  for (std::size_t k = 5; k < frames.size(); k += 23) frames[k].counts[7] = 4000.0F;
  EXPECT_EQ(channels_of(find_presses(frames)), pressed);
}

TEST(PressFinder, finds_nothing_where_nothing_is_pressed) {
  EXPECT_TRUE(find_presses(Board{.noise = 4.0}.frames(std::vector<int>(20, -1))).empty());
  EXPECT_TRUE(find_presses({}).empty());
}

TEST(PressFinder, names_the_channel_that_changed_nearly_as_much) {
  const std::vector<Press> presses = find_presses(Board{.neighbour = 0.9}.frames({16}));
  ASSERT_EQ(presses.size(), 1U);
  EXPECT_EQ(presses.front().second, 15U);
  EXPECT_NEAR(presses.front().second_share, 0.9, 0.03);
  EXPECT_NEAR(std::chrono::duration<double>(presses.front().begin).count(), 1.0, 0.1);
  EXPECT_NEAR(std::chrono::duration<double>(presses.front().end).count(), 1.6, 0.15);
}

}  // namespace
}  // namespace dermis::learn::arrangement
