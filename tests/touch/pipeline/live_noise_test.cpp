// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/pipeline/live_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::touch::pipeline {
namespace {

constexpr std::size_t kRows = 10;
constexpr std::size_t kCols = 12;
constexpr double kUnloaded = 5.0;  // calibrated standard deviations above the end of the ADC
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Deviation of a taxel from its unloaded conductance in a frame, in calibrated standard deviations.
using Deviation = std::function<double(std::size_t frame, std::size_t taxel)>;

class Stream {
 public:
  explicit Stream(double unloaded = kUnloaded) : unloaded_(kRows * kCols, unloaded), noise_(array(), unloaded_) {
    conductance_.siemens.resize(unloaded_.size());
    conductance_.sigma_siemens.resize(unloaded_.size());
    force_.signal_to_noise.resize(unloaded_.size());
  }

  void show(std::size_t frames, const Deviation& deviation) {
    for (std::size_t k = 0; k < frames; ++k, ++frame_) {
      conditioned_.sigma_ratio = 1.0;
      noise_.raise(conditioned_);
      for (std::size_t taxel = 0; taxel < unloaded_.size(); ++taxel) {
        double& siemens = conductance_.siemens[taxel];
        siemens = std::max(unloaded_[taxel] + deviation(frame_, taxel), 0.0);
        conductance_.sigma_siemens[taxel] = conditioned_.sigma_ratio;
        force_.signal_to_noise[taxel] = static_cast<float>((siemens - unloaded_[taxel]) / conditioned_.sigma_ratio);
      }
      noise_.observe(conductance_, force_);
    }
    noise_.raise(conditioned_);
  }

  [[nodiscard]] double measured() const { return noise_.measured(); }
  [[nodiscard]] double growth() const { return conditioned_.noise_growth; }
  [[nodiscard]] const std::vector<float>& shared() const { return conditioned_.shared_noise; }

 private:
  static ArrayDescription array() {
    ArrayDescription array;
    array.rows = kRows;
    array.cols = kCols;
    return array;
  }

  std::vector<double> unloaded_;
  LiveNoise noise_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  ForceFrame force_;
  std::size_t frame_ = 0;
};

/// Presses of any force on a fifth of the taxels, other ones in each frame.
Deviation with_touches(const Deviation& noise, Random& random) {
  return [&random, noise](std::size_t frame, std::size_t taxel) {
    return noise(frame, taxel) + (random.below(5) == 0 ? random.log_uniform(0.3, 1000.0) : 0.0);
  };
}

TEST(LiveNoise, noise_as_calibrated_is_never_raised) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Stream stream;
    const Deviation noise = [&](std::size_t, std::size_t) { return random.normal(); };
    for (int k = 0; k < 300; ++k) {
      stream.show(1, k < 100 ? noise : with_touches(noise, random));
      EXPECT_EQ(stream.growth(), 1.0) << "seed " << seed << ", frame " << k;
    }
    EXPECT_NEAR(stream.measured(), 1.0, 0.1) << "seed " << seed;
  }
}

TEST(LiveNoise, a_new_press_in_each_frame_is_no_noise) {
  Random random(3);
  Stream stream;
  stream.show(200, with_touches([](std::size_t, std::size_t) { return 0.0; }, random));
  EXPECT_EQ(stream.growth(), 1.0);
}

/// Dead rows under presses all around, from the first frame or from one on.
TEST(LiveNoise, dead_rows_are_no_noise) {
  for (const double reads : {-kUnloaded, -kUnloaded + 0.2, -kUnloaded + 1.0}) {
    for (const std::size_t from : {0U, 150U}) {
      Random random(6);
      Stream stream;
      const Deviation healthy = with_touches([&](std::size_t, std::size_t) { return random.normal(); }, random);
      const Deviation deviation = [&](std::size_t frame, std::size_t taxel) {
        return frame >= from && taxel / kCols < 4 ? reads : healthy(frame, taxel);
      };
      for (int k = 0; k < 300; ++k) {
        stream.show(1, deviation);
        ASSERT_EQ(stream.growth(), 1.0) << "frame " << k << ", reads " << reads << ", from " << from;
      }
    }
  }
}

TEST(LiveNoise, frames_of_zeros_are_no_noise) {
  Random random(7);
  Stream stream;
  const Deviation healthy = with_touches([&](std::size_t, std::size_t) { return random.normal(); }, random);
  stream.show(100, healthy);
  stream.show(300, [](std::size_t, std::size_t) { return -kUnloaded; });
  EXPECT_EQ(stream.growth(), 1.0);
  stream.show(100, healthy);
  EXPECT_EQ(stream.growth(), 1.0);
}

TEST(LiveNoise, a_zero_that_has_moved_is_no_noise) {
  for (const double moved : {-2.0, 2.0}) {
    Random random(4);
    Stream stream;
    stream.show(200, with_touches([&](std::size_t, std::size_t) { return moved + random.normal(); }, random));
    EXPECT_EQ(stream.growth(), 1.0) << moved;
  }
}

TEST(LiveNoise, white_noise_is_measured_in_fifty_frames_with_touches_and_cut_at_zero) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const double times : {1.5, 2.0, 4.0, 8.0}) {
      Random random(seed);
      Stream stream;
      stream.show(50, with_touches([&](std::size_t, std::size_t) { return times * random.normal(); }, random));
      EXPECT_NEAR(stream.growth() / times, 1.0, 0.25) << times << " times, seed " << seed;
    }
  }
}

TEST(LiveNoise, hum_is_measured_at_any_rate_of_frames) {
  constexpr double kAmplitude = 10.0;
  for (const double hertz : {10.0, 20.0, 60.0, 99.0, 100.0, 500.0}) {
    Random random(5);
    Stream stream;
    stream.show(500, [&](std::size_t frame, std::size_t taxel) {
      const double scanned = 0.9 * static_cast<double>(taxel) / static_cast<double>(kRows * kCols);
      const double seconds = (static_cast<double>(frame) + scanned) / hertz;
      return random.normal() + kAmplitude * std::sin(kTwoPi * 49.97 * seconds);
    });
    EXPECT_NEAR(stream.growth() / std::hypot(1.0, kAmplitude / std::numbers::sqrt2), 1.0, 0.25) << hertz << " Hz";
  }
}

TEST(LiveNoise, noise_that_has_ended_is_forgotten) {
  Random random(6);
  Stream stream;
  stream.show(100, [&](std::size_t, std::size_t) { return 3.0 * random.normal(); });
  EXPECT_GT(stream.growth(), 2.5);
  stream.show(2000, [&](std::size_t, std::size_t) { return random.normal(); });
  EXPECT_EQ(stream.growth(), 1.0);
}

TEST(LiveNoise, readings_at_the_end_of_the_adc_tell_nothing) {
  Random random(7);
  Stream stream(1.0);
  stream.show(100, [&](std::size_t, std::size_t) { return 3.0 * random.normal(); });
  EXPECT_EQ(stream.measured(), 0.0);
  EXPECT_EQ(stream.growth(), 1.0);
}

TEST(LiveNoise, white_noise_is_shared_by_no_lines) {
  Random random(8);
  Stream stream;
  stream.show(300, [&](std::size_t, std::size_t) { return 3.0 * random.normal(); });
  for (const float share : stream.shared()) EXPECT_LT(std::abs(share), 0.03F);
}

TEST(LiveNoise, hum_is_shared_by_lines_as_its_phase_turns) {
  constexpr double kTurn = 0.4;
  Random random(9);
  Stream stream(20.0);
  stream.show(300, [&](std::size_t frame, std::size_t taxel) {
    const std::size_t row = taxel / kCols;
    const double phase = 0.7 * static_cast<double>(frame) + kTurn * static_cast<double>(row);
    return 2.0 * random.normal() + 4.0 * std::sin(phase);
  });
  ASSERT_EQ(stream.shared().size(), kRows);
  for (std::size_t distance = 0; distance < kRows; ++distance) {
    const double expected = 8.0 / 12.0 * std::cos(kTurn * static_cast<double>(distance));
    EXPECT_NEAR(stream.shared()[distance], expected, 0.08) << distance << " lines";
  }
}

TEST(LiveNoise, nothing_is_allocated_when_noise_begins) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(10);
  Stream stream;
  const Deviation calm = [&](std::size_t, std::size_t) { return random.normal(); };
  const Deviation loud = [&](std::size_t, std::size_t) { return 4.0 * random.normal(); };
  stream.show(1, calm);
  const support::AllocationGuard guard;
  stream.show(20, calm);
  stream.show(200, loud);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(stream.growth(), 3.0);
}

}  // namespace
}  // namespace dermis::touch::pipeline
