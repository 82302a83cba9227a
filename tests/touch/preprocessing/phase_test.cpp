// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/phase.hpp"

#include <gtest/gtest.h>

namespace dermis::touch::preprocessing {
namespace {

using std::chrono::seconds;

TEST(PhaseSelector, settles_for_its_time_and_then_operates_for_good) {
  PhaseSelector selector(seconds(10), Phase::operate);
  EXPECT_EQ(selector.phase_at(seconds(0)), Phase::settle);
  EXPECT_EQ(selector.phase_at(seconds(10) - Nanos(1)), Phase::settle);
  EXPECT_EQ(selector.phase_at(seconds(10)), Phase::operate);
  EXPECT_EQ(selector.phase_at(seconds(100'000)), Phase::operate);
}

TEST(PhaseSelector, clock_starts_with_the_first_frame) {
  PhaseSelector selector(seconds(10), Phase::calibrate);
  EXPECT_EQ(selector.phase_at(seconds(1000)), Phase::settle);
  EXPECT_EQ(selector.phase_at(seconds(1009)), Phase::settle);
  EXPECT_EQ(selector.phase_at(seconds(1010)), Phase::calibrate);
}

TEST(PhaseSelector, clock_may_start_below_zero) {
  PhaseSelector selector(seconds(10), Phase::operate);
  EXPECT_EQ(selector.phase_at(seconds(-20)), Phase::settle);
  EXPECT_EQ(selector.phase_at(seconds(-10)), Phase::operate);
}

TEST(PhaseSelector, without_settling_the_first_frame_counts) {
  PhaseSelector selector(Nanos(0), Phase::operate);
  EXPECT_EQ(selector.select(seconds(3), false), Destination::pipeline);
}

TEST(PhaseSelector, frames_go_nowhere_while_settling) {
  for (const Phase after : {Phase::calibrate, Phase::operate}) {
    PhaseSelector selector(seconds(1), after);
    EXPECT_EQ(selector.select(Nanos(0), true), Destination::nowhere);
    EXPECT_EQ(selector.select(Nanos(1), false), Destination::nowhere);
  }
}

TEST(PhaseSelector, only_labelled_frames_reach_the_sample_database) {
  PhaseSelector selector(Nanos(0), Phase::calibrate);
  EXPECT_EQ(selector.select(seconds(1), true), Destination::sample_database);
  EXPECT_EQ(selector.select(seconds(2), false), Destination::nowhere);
}

TEST(PhaseSelector, every_frame_reaches_the_pipeline_while_operating) {
  PhaseSelector selector(Nanos(0), Phase::operate);
  EXPECT_EQ(selector.select(seconds(1), true), Destination::pipeline);
  EXPECT_EQ(selector.select(seconds(2), false), Destination::pipeline);
}

TEST(Phase, stays_settled_when_the_clock_goes_back) {
  PhaseSelector at_once(Nanos(0), Phase::operate);
  EXPECT_EQ(at_once.phase_at(Nanos(100)), Phase::operate);
  EXPECT_EQ(at_once.phase_at(Nanos(5)), Phase::operate);

  PhaseSelector later(Nanos(10), Phase::calibrate);
  EXPECT_EQ(later.phase_at(Nanos(100)), Phase::settle);
  EXPECT_EQ(later.phase_at(Nanos(0)), Phase::settle);  // the clock starts anew
  EXPECT_EQ(later.phase_at(Nanos(9)), Phase::settle);
  EXPECT_EQ(later.phase_at(Nanos(10)), Phase::calibrate);
  EXPECT_EQ(later.phase_at(Nanos(3)), Phase::calibrate);
}

}  // namespace
}  // namespace dermis::touch::preprocessing
