// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/clock_mapping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis {
namespace {

constexpr double kMedianOfExponential = 0.6931471805599453;

/// A device whose clock runs fast by `drift`, read over a line whose delay is exponential, with bursts.
struct Device {
  double drift = 0.0;
  double mean_delay_s = 0.0;
  double rate_hz = 1000.0;
  double burst_every_s = 0.0;  ///< 0: no bursts; else all frames of 50 ms arrive together, at their end.
  double device_offset_s = 1234.5;

  /// Device time and arrival of the frame that is taken at `taken_s` of the host.
  std::pair<Nanos, Nanos> read(double taken_s, Random& random) const {
    double arrival_s = taken_s - mean_delay_s * std::log(1.0 - random.uniform());
    if (burst_every_s > 0.0) {
      const double in_burst_s = std::fmod(taken_s, burst_every_s);
      if (in_burst_s < 0.05) arrival_s = std::max(arrival_s, taken_s - in_burst_s + 0.05);
    }
    last_arrival_s = std::max(last_arrival_s, arrival_s);  // in order
    const double device_s = device_offset_s + (1.0 + drift) * taken_s;
    return {Nanos(std::llround(1e9 * device_s)), Nanos(std::llround(1e9 * last_arrival_s))};
  }
  mutable double last_arrival_s = 0.0;
};

double seconds(Nanos time) {
  return 1e-9 * static_cast<double>(time.count());
}

TEST(ClockMapping, finds_offset_and_drift_through_jitter_and_bursts) {
  for (const double drift_ppm : {-200.0, -20.0, 0.0, 50.0, 200.0}) {
    for (const double mean_delay_s : {1e-4, 2e-3}) {
      for (const double burst_every_s : {0.0, 1.0}) {
        SCOPED_TRACE(testing::Message() << drift_ppm << " ppm, " << mean_delay_s << " s, bursts " << burst_every_s);
        Random random(7);
        const Device device{1e-6 * drift_ppm, mean_delay_s, 1000.0, burst_every_s};
        ClockMapping clock;
        double worst_s = 0.0;
        for (int frame = 0; frame < 60'000; ++frame) {
          const double taken_s = 0.001 * frame;
          const auto [device_time, arrival] = device.read(taken_s, random);
          const Nanos mapped = clock.map(device_time, arrival);
          ASSERT_LE(mapped, arrival);
          if (frame >= 10'000) worst_s = std::max(worst_s, std::abs(seconds(mapped) - taken_s));
        }
        EXPECT_LT(worst_s, kMedianOfExponential * mean_delay_s);
        ASSERT_TRUE(clock.drift_ppm());
        EXPECT_NEAR(*clock.drift_ppm(), drift_ppm, 3.0);
      }
    }
  }
}

TEST(ClockMapping, follows_a_drift_that_changes) {
  Random random(3);
  Device device{0.0, 1e-3};
  ClockMapping clock;
  double device_s = 0.0;
  for (int frame = 0; frame < 120'000; ++frame) {
    const double taken_s = 0.001 * frame;
    const double drift = frame < 60'000 ? 50e-6 : -50e-6;
    device_s += 0.001 * (1.0 + drift);
    const double arrival_s = std::max(device.last_arrival_s, taken_s - 1e-3 * std::log(1.0 - random.uniform()));
    device.last_arrival_s = arrival_s;
    const Nanos mapped = clock.map(Nanos(std::llround(1e9 * device_s)), Nanos(std::llround(1e9 * arrival_s)));
    if (frame >= 100'000) {
      ASSERT_NEAR(seconds(mapped), taken_s, 5e-4) << frame;
    }
  }
  EXPECT_NEAR(*clock.drift_ppm(), -50.0, 3.0);
}

TEST(ClockMapping, without_delay_gives_back_the_arrivals) {
  ClockMapping clock;
  for (std::int64_t frame = 0; frame < 1000; ++frame) {
    const Nanos arrival(frame * 1'000'000);
    EXPECT_EQ(clock.map(arrival + Nanos(77), arrival), arrival);
  }
  EXPECT_FALSE(clock.drift_ppm()) << "not a second";
}

TEST(ClockMapping, begins_anew_when_the_device_does) {
  for (const double leap_s : {-500.0, 3.0, 1e9}) {
    SCOPED_TRACE(leap_s);
    Random random(5);
    Device device{100e-6, 1e-3};
    ClockMapping clock;
    double worst_s = 0.0;
    for (int frame = 0; frame < 40'000; ++frame) {
      if (frame == 20'000) device.device_offset_s += leap_s;
      const double taken_s = 0.001 * frame;
      const auto [device_time, arrival] = device.read(taken_s, random);
      const Nanos mapped = clock.map(device_time, arrival);
      ASSERT_LE(mapped, arrival);
      if (frame >= 30'000) worst_s = std::max(worst_s, std::abs(seconds(mapped) - taken_s));
    }
    EXPECT_LT(worst_s, 1e-3 * kMedianOfExponential);
    EXPECT_NEAR(*clock.drift_ppm(), 100.0, 5.0);
  }
}

TEST(ClockMapping, takes_frames_of_one_tick_for_no_restart) {
  Random random(13);
  const Device device{100e-6, 5e-4};
  ClockMapping clock;
  double worst_s = 0.0;
  for (int frame = 0; frame < 40'000; ++frame) {
    const double taken_s = 0.0005 * frame;  // two a tick
    const auto [device_time, arrival] = device.read(taken_s, random);
    const Nanos mapped = clock.map(std::chrono::floor<std::chrono::milliseconds>(device_time), arrival);
    ASSERT_LE(mapped, arrival);
    if (frame >= 10'000) worst_s = std::max(worst_s, std::abs(seconds(mapped) - taken_s));
  }
  EXPECT_LT(worst_s, 1.1e-3) << "the tick, but not the delays, which are up to ten times their mean";
  ASSERT_TRUE(clock.drift_ppm());
  EXPECT_NEAR(*clock.drift_ppm(), 100.0, 5.0);
}

TEST(ClockMapping, a_clock_that_does_not_run_is_none) {
  ClockMapping clock;
  std::int64_t ms = 0;
  for (; ms < 500; ++ms) {
    const Nanos arrival = std::chrono::milliseconds(ms);
    EXPECT_EQ(clock.map(Nanos(7), arrival), arrival);
  }
  for (; ms < 2000; ++ms) (void)clock.map(std::chrono::milliseconds(ms), std::chrono::milliseconds(ms));
  for (; ms < 3100; ++ms) (void)clock.map(std::chrono::milliseconds(1999), std::chrono::milliseconds(ms));
  for (; ms < 3200; ++ms) {
    const Nanos arrival = std::chrono::milliseconds(ms);
    EXPECT_EQ(clock.map(std::chrono::milliseconds(1999), arrival), arrival);
  }
}

TEST(ClockMapping, bears_any_device_time_and_allocates_nothing) {
  Random random(11);
  ClockMapping clock;
  const support::AllocationGuard guard;
  for (int frame = 0; frame < 100'000; ++frame) {
    const auto device = static_cast<std::int64_t>(random.bits());
    const Nanos arrival(std::int64_t{frame} * 1'000'000);
    ASSERT_LE(clock.map(Nanos(device), arrival), arrival);
  }
  if (support::kAllocationsAreCounted) {
    EXPECT_EQ(guard.count(), 0U);
  }
}

}  // namespace
}  // namespace dermis
