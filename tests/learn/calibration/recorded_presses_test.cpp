// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/recorded_presses.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace dermis::learn::calibration {
namespace {

/// Frames of 10 Hz; those of `late` come a minute later.
std::vector<RawFrame> frames_of(std::size_t count, std::size_t late) {
  std::vector<RawFrame> frames(count);
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].time = std::chrono::milliseconds(100 * k) + std::chrono::minutes(k >= late ? 1 : 0);
  }
  return frames;
}

std::vector<Load> loads_of(const std::vector<double>& newtons) {
  std::vector<Load> loads;
  for (std::size_t k = 0; k < newtons.size(); ++k) {
    if (newtons[k] >= 0.0) loads.push_back({k, LoadKind::force, {}, newtons[k]});
  }
  return loads;
}

constexpr double kNothingSaid = -1.0;

TEST(RecordedPresses, a_press_ends_where_frames_are_labelled_unloaded_again) {
  const auto presses = recorded_presses(frames_of(7, 7), loads_of({0, kNothingSaid, 5, 5, 0, 3, kNothingSaid}));
  EXPECT_EQ(presses, (std::vector<RecordedPress>{{0, 4}, {4, 7}}));
}

TEST(RecordedPresses, a_press_ends_at_a_pause) {
  const auto presses = recorded_presses(frames_of(5, 3), loads_of({5, 5, kNothingSaid, 5, 5}));
  EXPECT_EQ(presses, (std::vector<RecordedPress>{{0, 3}, {3, 5}}));
}

TEST(RecordedPresses, what_has_no_load_is_no_press) {
  EXPECT_TRUE(recorded_presses(frames_of(3, 1), loads_of({0, 0, kNothingSaid})).empty());
}

TEST(RecordedPresses, one_press_cannot_be_left_out) {
  const std::vector<RecordedPress> presses{{0, 3}};
  const Status judged =
      judge_each_left_out({}, frames_of(3, 3), loads_of({0, 5, 5}), presses,
                          [](const RecordedPress&, auto, const Calibration&) -> Status { return Done{}; });
  ASSERT_FALSE(judged);
  EXPECT_NE(judged.error().message.find("fewer than two presses"), std::string::npos);
}

}  // namespace
}  // namespace dermis::learn::calibration
