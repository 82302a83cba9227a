// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/arrival_meter.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace dermis {
namespace {

using std::chrono::milliseconds;

TEST(ArrivalMeter, knows_rate_and_jitter_of_the_last_seconds) {
  ArrivalMeter meter;
  EXPECT_EQ(meter.rate_hz(), 0.0);
  EXPECT_EQ(meter.jitter(), Nanos{});
  Nanos now{};
  for (int k = 0; k < 1000; ++k) meter.add(now += milliseconds(k % 2 == 0 ? 4 : 6));
  EXPECT_NEAR(meter.rate_hz(), 200.0, 0.5);
  EXPECT_NEAR(static_cast<double>(meter.jitter().count()), 1e6, 1e4);
  for (int k = 0; k < 1000; ++k) meter.add(now += milliseconds(10));
  EXPECT_NEAR(meter.rate_hz(), 100.0, 0.5) << "the first ones are forgotten";
}

}  // namespace
}  // namespace dermis
