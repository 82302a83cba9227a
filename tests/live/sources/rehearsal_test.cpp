// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/rehearsal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "live/sources/small_array.hpp"

namespace dermis::live::sources {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr double kRateHz = 100.0;
constexpr float kPressedCounts = 60.0F;

/// A hand and the guide that it obeys.
class RehearsalTest : public testing::Test {
 protected:
  /// The taxel that is pressed after another `time`, if one is.
  std::optional<std::size_t> pressed_after(std::chrono::milliseconds time) {
    for (std::int64_t i = 0; i < time.count() / 10; ++i) rehearsal_.read(number_++, frame_);
    const auto heaviest = std::max_element(frame_.counts.begin(), frame_.counts.end());
    if (*heaviest < kPressedCounts) return std::nullopt;
    return static_cast<std::size_t>(heaviest - frame_.counts.begin());
  }

  void ask_for(std::size_t taxel) { guide_->speak({.press = true, .taxel = taxel, .weight_n = 5.0, .hold_time = 1s}); }
  void tell_to_release() { guide_->speak({.hold_time = 1s}); }

  std::shared_ptr<GuideVoice> guide_ = std::make_shared<GuideVoice>();
  Rehearsal rehearsal_ = *Rehearsal::create(small_array(), 1, kRateHz, guide_);
  RawFrame frame_;
  std::uint64_t number_ = 0;
};

TEST_F(RehearsalTest, a_hand_listens_to_the_guide) {
  EXPECT_TRUE(guide_->has_listener());
}

TEST_F(RehearsalTest, nothing_is_pressed_unless_asked_for) {
  EXPECT_EQ(pressed_after(5s), std::nullopt);
}

TEST_F(RehearsalTest, puts_the_weight_on_after_a_hold_and_takes_it_off_when_told) {
  ask_for(7);
  EXPECT_EQ(pressed_after(900ms), std::nullopt);
  EXPECT_EQ(pressed_after(200ms), 7U);
  EXPECT_EQ(pressed_after(3s), 7U);
  tell_to_release();
  EXPECT_EQ(pressed_after(400ms), 7U);
  EXPECT_EQ(pressed_after(200ms), std::nullopt);
}

TEST_F(RehearsalTest, presses_harder_with_a_heavier_weight) {
  ask_for(7);
  ASSERT_EQ(pressed_after(2s), 7U);
  const float light = frame_.counts[7];
  tell_to_release();
  ASSERT_EQ(pressed_after(1s), std::nullopt);
  guide_->speak({.press = true, .taxel = 7, .weight_n = 20.0, .hold_time = 1s});
  ASSERT_EQ(pressed_after(2s), 7U);
  EXPECT_GT(frame_.counts[7], 1.5F * light);
}

TEST_F(RehearsalTest, time_passes_in_frames_that_are_left_out) {
  ask_for(7);
  ASSERT_EQ(pressed_after(100ms), std::nullopt);
  number_ += 100;
  EXPECT_EQ(pressed_after(10ms), 7U);
}

TEST(Rehearsal, gives_the_same_frames_for_the_same_seed) {
  Rehearsal first = *Rehearsal::create(small_array(), 5, kRateHz, nullptr);
  Rehearsal second = *Rehearsal::create(small_array(), 5, kRateHz, nullptr);
  RawFrame one;
  RawFrame other;
  for (std::uint64_t number = 0; number < 20; ++number) {
    first.read(number, one);
    second.read(number, other);
    ASSERT_EQ(one.counts, other.counts);
    ASSERT_EQ(one.temperature_celsius, other.temperature_celsius);
    ASSERT_EQ(one.supply_v, other.supply_v);
  }
}

}  // namespace
}  // namespace dermis::live::sources
