// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/guide_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace dermis::learn::calibration {
namespace {

ArrayDescription array_of_taxels() {
  ArrayDescription array;
  array.rows = 4;
  array.cols = 4;
  return array;
}

std::string words(GuideState state, GuideHint hint) {
  state.stage = GuideStage::pressing;
  state.hint = hint;
  return describe_press(state, array_of_taxels());
}

/// r1c1, while r1c2 is pressed.
GuideState single(double newtons) {
  GuideState state;
  state.taxel = 5;
  state.weight_n = newtons;
  state.pressed_taxel = 6;
  return state;
}

/// r1c1 and r3c2.
GuideState pair(double newtons) {
  GuideState state = single(newtons);
  state.together_with = 14;
  return state;
}

TEST(GuideMessages, tell_what_to_do_with_a_single_taxel) {
  const GuideState state = single(5.0);
  EXPECT_EQ(words(state, GuideHint::press), "Put 5 N (510 g) on r1c1.");
  EXPECT_EQ(words(state, GuideHint::hold), "Hold still.");
  EXPECT_EQ(words(state, GuideHint::release), "r1c1 is done. Take it off.");
  EXPECT_EQ(words(state, GuideHint::other_taxel), "That is r1c2: put 5 N (510 g) on r1c1.");
  EXPECT_EQ(words(state, GuideHint::unsteady), "Not steady yet: hold still.");
  EXPECT_EQ(words(state, GuideHint::too_short), "Too short: put 5 N (510 g) on r1c1 again and wait.");
  EXPECT_EQ(words(state, GuideHint::several), "r1c2 is pressed, too: press r1c1 alone.");
}

TEST(GuideMessages, name_both_taxels_of_a_pair) {
  const GuideState state = pair(20.0);
  EXPECT_EQ(words(state, GuideHint::press),
            "To be sure of the circuit, put 20 N (2.04 kg) on r1c1 and as much on r3c2.");
  EXPECT_EQ(words(state, GuideHint::hold), "Hold both still.");
  EXPECT_EQ(words(state, GuideHint::release), "r1c1 and r3c2 are done. Take both off.");
  EXPECT_EQ(words(state, GuideHint::other_taxel), "That is r1c2: put 20 N (2.04 kg) on r1c1 and as much on r3c2.");
  EXPECT_EQ(words(state, GuideHint::unsteady), "Not steady yet: hold both still.");
  EXPECT_EQ(words(state, GuideHint::too_short),
            "Too short: put 20 N (2.04 kg) on r1c1 and as much on r3c2 again and wait.");
  EXPECT_EQ(words(state, GuideHint::several), "r1c2 is pressed, too: press r1c1 and r3c2 alone.");
}

TEST(GuideMessages, tell_which_of_two_is_missing) {
  GuideState state = pair(20.0);
  state.missing_taxel = 5;
  EXPECT_EQ(words(state, GuideHint::other_taxel), "That is r1c2: put 20 N (2.04 kg) on r1c1 instead. r3c2 is right.");
  state.missing_taxel = 14;
  EXPECT_EQ(words(state, GuideHint::other_taxel), "That is r1c2: put 20 N (2.04 kg) on r3c2 instead. r1c1 is right.");
  state.pressed_taxel = 5;
  EXPECT_EQ(words(state, GuideHint::one_of_two), "Only r1c1 is pressed: put 20 N (2.04 kg) on r3c2, too.");
}

TEST(GuideMessages, the_result_holds_for_the_mean_of_several_sensors) {
  const auto press = std::make_shared<GuidedPress>();
  press->frames.resize(2);
  press->frames[0].sensor_celsius = {30.0F, 36.0F};
  press->frames[1].sensor_celsius = {32.0F, std::numeric_limits<float>::quiet_NaN()};
  Calibration calibration;
  calibration.model.array = array_of_taxels();
  EXPECT_NE(describe_result(calibration, {}, {press}).find("It holds for about 32 C"), std::string::npos);
  press->frames.clear();
  EXPECT_NE(describe_result(calibration, {}, {press}).find("It holds for the temperature of today."),
            std::string::npos);
}

}  // namespace
}  // namespace dermis::learn::calibration
