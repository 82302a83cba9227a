// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_recogniser.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

namespace dermis::learn::calibration {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr std::size_t kTaxels = 12;
constexpr double kRatioPerCount = 1.0 / 4095.0;
constexpr double kUnloaded = 0.01;
constexpr double kFrameSeconds = 0.01;

constexpr std::size_t kFirst = 2;
constexpr std::size_t kSecond = 7;
constexpr std::size_t kForeign = 3;
constexpr double kPress = 0.1;  // excess of a press over the unloaded ratio

using Excess = std::vector<std::pair<std::size_t, double>>;
using Event = PressRecogniser::Event;

TouchSense unloaded_sense() {
  FrameMean mean;
  RawFrame frame;
  frame.counts.assign(kTaxels, static_cast<float>(kUnloaded / kRatioPerCount));
  for (int k = 0; k < 10; ++k) mean.add(frame, std::vector<double>(kTaxels, kUnloaded));
  return {mean, kRatioPerCount};
}

/// An array without noise; what its taxels feel is set by the test.
class Recogniser : public testing::Test {
 protected:
  /// The last event other than `none`.
  Event feel(const Excess& excess, double seconds) {
    RawFrame frame;
    frame.counts.resize(kTaxels);
    std::vector<double> ratio(kTaxels, kUnloaded);
    for (const auto& [taxel, rise] : excess) ratio[taxel] += rise;
    Event last = Event::none;
    for (double done = 0.0; done < seconds; done += kFrameSeconds) {
      frame.time = (time_ += 10ms);
      if (const Event event = recogniser_.feed(frame, ratio, kFrameSeconds); event != Event::none) last = event;
      if (last == Event::held && recogniser_.hint() == GuideHint::hold) break;
    }
    return last;
  }

  void press_and_keep(const Excess& excess) {
    ASSERT_EQ(feel(excess, 3.0), Event::held);
    EXPECT_EQ(recogniser_.keep_hold(2).size(), 2U);
  }

  void expect_mistake(GuideHint hint, std::optional<std::size_t> pressed, std::optional<std::size_t> missing) {
    EXPECT_EQ(recogniser_.hint(), hint);
    EXPECT_EQ(recogniser_.pressed_taxel(), pressed);
    EXPECT_EQ(recogniser_.missing_taxel(), missing);
  }

  PressRecogniser recogniser_{unloaded_sense(), 1s};
  Nanos time_{};
};

TEST_F(Recogniser, holds_a_pair_while_both_are_pressed_and_nothing_else) {
  recogniser_.expect({kFirst, kSecond});
  EXPECT_EQ(feel({{kFirst, kPress}, {kSecond, 0.4 * kPress}}, 0.5), Event::none);
  expect_mistake(GuideHint::hold, kFirst, std::nullopt);
  EXPECT_NEAR(recogniser_.reading(0), 11.0, 1e-9);
  EXPECT_NEAR(recogniser_.reading(1), 5.0, 1e-9);
  EXPECT_EQ(feel({{kFirst, kPress}, {kSecond, 0.4 * kPress}}, 3.0), Event::held);
}

TEST_F(Recogniser, tells_which_of_two_is_still_to_be_pressed) {
  recogniser_.expect({kFirst, kSecond});
  feel({{kSecond, kPress}}, 0.5);
  expect_mistake(GuideHint::one_of_two, kSecond, kFirst);
  feel({{kFirst, kPress}}, 0.5);
  expect_mistake(GuideHint::one_of_two, kFirst, kSecond);
  feel({}, 0.5);
  expect_mistake(GuideHint::press, std::nullopt, std::nullopt);
}

TEST_F(Recogniser, tells_a_taxel_in_the_place_of_one_of_two_whichever_feels_more) {
  recogniser_.expect({kFirst, kSecond});
  for (const double foreign : {0.6 * kPress, 1.5 * kPress}) {
    feel({{kSecond, kPress}, {kForeign, foreign}}, 0.5);
    expect_mistake(GuideHint::other_taxel, kForeign, kFirst);
  }
}

TEST_F(Recogniser, tells_a_taxel_in_the_place_of_both) {
  recogniser_.expect({kFirst, kSecond});
  feel({{kForeign, kPress}}, 0.5);
  expect_mistake(GuideHint::other_taxel, kForeign, std::nullopt);
}

TEST_F(Recogniser, tells_a_third_taxel_beside_two_also_one_that_feels_least) {
  recogniser_.expect({kFirst, kSecond});
  for (const double foreign : {0.6 * kPress, 1.5 * kPress}) {
    feel({{kFirst, kPress}, {kSecond, 0.9 * kPress}, {kForeign, foreign}}, 0.5);
    expect_mistake(GuideHint::several, kForeign, std::nullopt);
  }
}

TEST_F(Recogniser, takes_crosstalk_for_no_third_taxel) {
  recogniser_.expect({kFirst, kSecond});
  EXPECT_EQ(feel({{kFirst, kPress}, {kSecond, kPress}, {kForeign, 0.4 * kPress}}, 3.0), Event::held);
}

TEST_F(Recogniser, begins_a_hold_anew_where_one_of_two_is_taken_off) {
  recogniser_.expect({kFirst, kSecond});
  feel({{kFirst, kPress}, {kSecond, kPress}}, 0.8);
  EXPECT_EQ(feel({{kFirst, kPress}}, 3.0), Event::none);
  expect_mistake(GuideHint::one_of_two, kFirst, kSecond);
  EXPECT_EQ(feel({{kFirst, kPress}, {kSecond, kPress}}, 1.2), Event::none);
}

TEST_F(Recogniser, holds_no_pair_of_which_the_second_moves) {
  recogniser_.expect({kFirst, kSecond});
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(feel({{kFirst, kPress}, {kSecond, (k % 2 == 0 ? 0.8 : 1.0) * kPress}}, 0.4), Event::none);
  }
  EXPECT_EQ(recogniser_.hint(), GuideHint::unsteady);
}

TEST_F(Recogniser, a_pair_is_released_when_both_are_though_they_feel_differently) {
  recogniser_.expect({kFirst, kSecond});
  press_and_keep({{kFirst, 0.3 * kPress}, {kSecond, kPress}});
  EXPECT_EQ(recogniser_.hint(), GuideHint::release);
  EXPECT_EQ(feel({{kSecond, kPress}}, 0.5), Event::none);
  EXPECT_EQ(feel({{kFirst, 0.3 * kPress}}, 0.5), Event::none);
  EXPECT_EQ(feel({{kFirst, 0.03 * kPress}, {kSecond, 0.1 * kPress}}, 0.1), Event::released) << "but for memory";
}

TEST_F(Recogniser, what_the_material_remembers_is_no_mistake) {
  recogniser_.expect({kForeign});
  press_and_keep({{kForeign, kPress}});
  const double memory = 0.14 * kPress;
  ASSERT_EQ(feel({{kForeign, memory}}, 0.1), Event::released);
  for (const std::vector<std::size_t>& taxels : {std::vector{kFirst}, {kFirst, kSecond}}) {
    recogniser_.expect(taxels);
    feel({{kForeign, memory}}, 0.5);
    EXPECT_EQ(recogniser_.hint(), GuideHint::press);
    Excess light = {{kForeign, memory}};
    for (const std::size_t taxel : taxels) light.emplace_back(taxel, 0.05 * kPress);
    EXPECT_EQ(feel(light, 3.0), Event::held);
  }
}

TEST_F(Recogniser, holds_nothing_that_a_press_has_left_on_the_taxel_that_is_asked_for) {
  const double memory = 0.14 * kPress;
  recogniser_.expect({kFirst});
  feel({{kFirst, kPress}}, 0.5);
  EXPECT_EQ(feel({{kFirst, memory}}, 5.0), Event::none) << "after a press that was too short";
  EXPECT_EQ(recogniser_.hint(), GuideHint::too_short);
  press_and_keep({{kFirst, kPress}});
  ASSERT_EQ(feel({{kFirst, memory}}, 0.1), Event::released);
  recogniser_.expect({kFirst});
  EXPECT_EQ(feel({{kFirst, memory}}, 5.0), Event::none) << "when the press is repeated";
  EXPECT_EQ(recogniser_.hint(), GuideHint::press);
  EXPECT_EQ(feel({{kFirst, memory + 0.05 * kPress}}, 3.0), Event::held) << "a lighter weight";
}

TEST_F(Recogniser, what_fades_in_the_material_leaves_room_for_a_lighter_weight) {
  recogniser_.expect({kFirst});
  press_and_keep({{kFirst, kPress}});
  ASSERT_EQ(feel({{kFirst, 0.14 * kPress}}, 0.1), Event::released);
  recogniser_.expect({kFirst});
  feel({}, 0.1);
  EXPECT_EQ(feel({{kFirst, 0.1 * kPress}}, 3.0), Event::held);
}

TEST_F(Recogniser, tells_single_taxels_that_are_pressed_instead_or_too) {
  recogniser_.expect({kFirst});
  feel({{kForeign, kPress}}, 0.5);
  expect_mistake(GuideHint::other_taxel, kForeign, std::nullopt);
  feel({{kForeign, kPress}, {kFirst, 0.8 * kPress}}, 0.5);
  expect_mistake(GuideHint::several, kForeign, std::nullopt);
  feel({{kForeign, 0.8 * kPress}, {kFirst, kPress}}, 0.5);
  expect_mistake(GuideHint::several, kForeign, std::nullopt);
}

}  // namespace
}  // namespace dermis::learn::calibration
