// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/live_recognition.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "out/serve/named_touches.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::out::serve {
namespace {

using learn::recognition::Answer;

LiveRecognition recognition_of(const learn::recognition::Classes& classes) {
  Result<LiveRecognition> made =
      LiveRecognition::create(classes, {learn::recognition::sensed_array(touched_array(), "skin")});
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

std::string name_of(const LiveRecognition& recognition, const Answer& answer) {
  return recognition.classes().names[answer.likeliest];
}

/// What is told of a gesture that begins after half a second, at so many frames a second; two seconds of it.
std::vector<std::string> told_of(LiveRecognition& recognition, bool is_tap, double rate_hz) {
  Random random(3);
  std::vector<std::string> told;
  for (int frame = 0; frame < static_cast<int>(2.0 * rate_hz); ++frame) {
    const double seconds = frame / rate_hz;
    const Nanos time(static_cast<std::int64_t>(1e9 * seconds));
    const auto answer = recognition.next(force_frame(time, touch(random, true, course(is_tap, seconds - 0.5))));
    if (answer) told.push_back(name_of(recognition, *answer));
  }
  return told;
}

TEST(LiveRecognition, tells_a_pose_when_it_changes_and_ten_times_a_second) {
  LiveRecognition recognition = recognition_of(left_and_right());
  Random random(4);
  std::vector<std::string> told;
  for (int frame = 0; frame < 4000; ++frame) {
    const auto answer = recognition.next(force_frame(Nanos(frame * 1'000'000LL), touch(random, frame < 2000, 4.0)));
    if (answer) told.push_back(name_of(recognition, *answer));
  }
  EXPECT_GE(told.size(), 30U);
  EXPECT_LE(told.size(), 60U);
  EXPECT_EQ(told.front(), "left");
  EXPECT_EQ(told.back(), "right");
}

TEST(LiveRecognition, tells_a_gesture_once_whatever_the_rate_of_the_array) {
  const learn::recognition::Classes classes = taps_and_holds();
  for (const double rate_hz : {50.0, 100.0, 1000.0}) {
    LiveRecognition taps = recognition_of(classes);
    EXPECT_EQ(told_of(taps, true, rate_hz), std::vector<std::string>{"tap"}) << rate_hz;
    LiveRecognition holds = recognition_of(classes);
    EXPECT_EQ(told_of(holds, false, rate_hz), std::vector<std::string>{"hold"}) << rate_hz;
  }
}

TEST(LiveRecognition, does_not_answer_for_a_gesture_that_a_gap_or_a_leap_in_time_cuts) {
  const learn::recognition::Classes classes = taps_and_holds();
  for (const std::int64_t leap_s : {-10, 10}) {
    LiveRecognition recognition = recognition_of(classes);
    Random random(5);
    for (int frame = 0; frame < 200; ++frame) {
      const Nanos time(frame * 10'000'000LL + (frame < 120 ? 0 : leap_s * 1'000'000'000));
      const double newtons = frame >= 100 && frame < 120 ? 4.0 : 0.0;
      EXPECT_FALSE(recognition.next(force_frame(time, touch(random, true, newtons)))) << leap_s << ", " << frame;
    }
  }
}

TEST(LiveRecognition, passes_over_frames_that_are_rejected) {
  LiveRecognition recognition = recognition_of(left_and_right());
  Random random(6);
  ForceFrame frame = force_frame(Nanos(0), touch(random, true, 4.0));
  frame.status = FrameStatus::rejected;
  EXPECT_FALSE(recognition.next(frame));
}

TEST(LiveRecognition, refuses_classes_that_do_not_fit_the_array) {
  learn::recognition::Classes classes = left_and_right();
  classes.layout.arrays[0].row_pitch_mm = classes.layout.arrays[0].col_pitch_mm = 0.0;
  const auto misfit =
      LiveRecognition::create(classes, {learn::recognition::sensed_array(support::reference_array(3, 4), "skin")});
  ASSERT_FALSE(misfit);
  EXPECT_NE(misfit.error().message.find("array 'skin' has 3x4 taxels, the examples were of"), std::string::npos)
      << misfit.error().message;
}

TEST(LiveRecognition, refuses_classes_of_other_further_readings) {
  const auto misfit =
      LiveRecognition::create(left_and_right(), {learn::recognition::sensed_array(touched_array(), "skin")}, 1);
  ASSERT_FALSE(misfit);
  EXPECT_EQ(misfit.error().message, "there are 1 further readings beside a frame, the examples had 0");
}

TEST(LiveRecognition, allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  LiveRecognition recognition = recognition_of(left_and_right());
  Random random(7);
  std::vector<ForceFrame> frames;
  for (int frame = 0; frame < 100; ++frame) {
    frames.push_back(force_frame(Nanos(frame * 10'000'000LL), touch(random, true, 4.0)));
  }
  const support::AllocationGuard guard;
  for (const ForceFrame& frame : frames) static_cast<void>(recognition.next(frame));
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::out::serve
