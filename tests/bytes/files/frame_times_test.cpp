// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/frame_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::files {
namespace {

/// Adds frames, and keeps the time of the last one.
class Recorder {
 public:
  Recorder& at(double time_s) {
    time_s_ = time_s;
    clock_.add(Nanos(std::llround(1e9 * time_s)));
    return *this;
  }
  Recorder& frames(std::size_t count, double step_s) {
    for (std::size_t k = 0; k < count; ++k) at(time_s_ + step_s);
    return *this;
  }
  [[nodiscard]] const FrameTimes& clock() const { return clock_; }

 private:
  FrameTimes clock_;
  double time_s_ = 0.0;
};

TEST(FrameTimes, doubts_nothing_of_steady_frames) {
  for (const double step : {0.001, 0.02, 0.1, 1.0, 10.0}) {
    const Recorder recorder = Recorder().frames(500, step);
    EXPECT_TRUE(recorder.clock().findings().empty()) << step;
    EXPECT_FALSE(recorder.clock().wrong_unit(false)) << step;
    EXPECT_NEAR(recorder.clock().seconds(), 499 * step, 1e-6) << step;
  }
}

TEST(FrameTimes, doubts_no_jitter_pause_or_batch) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    Recorder recorder;
    for (int frame = 0; frame < 600; ++frame) {
      const double pause = frame > 300 ? 7.0 : 0.0;
      const double batch = 0.02 * (frame - frame % 4);
      recorder.at(pause + batch + 0.006 * random.uniform(0.0, 1.0) + (frame % 4) * 1e-4);
    }
    EXPECT_TRUE(recorder.clock().findings().empty()) << seed << ": " << recorder.clock().findings().front();
  }
}

TEST(FrameTimes, names_a_restart_and_counts_on) {
  const Recorder recorder = Recorder().at(1.0).frames(199, 0.02).at(0.9).frames(199, 0.02);
  ASSERT_EQ(recorder.clock().findings().size(), 1U);
  EXPECT_EQ(
      recorder.clock().findings().front().rfind("the clock restarts at frame 200: from 4.980 s back to 0.900 s", 0), 0U)
      << recorder.clock().findings().front();
  EXPECT_NEAR(recorder.clock().seconds(), 399 * 0.02, 1e-6);
}

TEST(FrameTimes, names_few_of_many_restarts) {
  Recorder recorder;
  for (int part = 0; part < 40; ++part) recorder.at(0.0).frames(50, 0.02);
  EXPECT_EQ(recorder.clock().findings().size(), 5U);
  EXPECT_EQ(recorder.clock().findings().back(), "the clock restarts 39 times in all");
}

TEST(FrameTimes, names_milliseconds_and_microseconds) {
  const Recorder odd = Recorder().frames(300, 20.7039);
  ASSERT_TRUE(odd.clock().wrong_unit(false));
  EXPECT_NE(odd.clock().wrong_unit(false)->find("milliseconds"), std::string::npos);
  const Recorder round = Recorder().frames(300, 20.0);
  EXPECT_FALSE(round.clock().wrong_unit(false));
  EXPECT_TRUE(round.clock().wrong_unit(true));
  const Recorder micro = Recorder().frames(300, 20000.0);
  ASSERT_TRUE(micro.clock().wrong_unit(false));
  EXPECT_NE(micro.clock().wrong_unit(false)->find("microseconds"), std::string::npos);
}

TEST(FrameTimes, names_the_place_where_the_rate_jumps) {
  for (const std::size_t jump : {100U, 128U, 170U, 215U}) {
    const Recorder recorder = Recorder().frames(jump, 0.02).frames(400 - jump, 0.04);
    ASSERT_EQ(recorder.clock().findings().size(), 1U) << jump;
    const std::string said = recorder.clock().findings().front();
    EXPECT_EQ(said.rfind("the rate jumps from 50 to 25 frames a second near frame ", 0), 0U) << said;
    EXPECT_NEAR(std::stod(said.substr(said.find("frame ", 40) + 6)), static_cast<double>(jump), 40.0) << said;
  }
}

TEST(FrameTimes, keeps_the_jump_of_a_long_stream) {
  const Recorder recorder = Recorder().frames(60000, 0.01).frames(60000, 0.02);
  ASSERT_EQ(recorder.clock().findings().size(), 1U);
  EXPECT_NEAR(recorder.clock().seconds(), 1800.0, 1.0);
}

}  // namespace
}  // namespace dermis::bytes::files
