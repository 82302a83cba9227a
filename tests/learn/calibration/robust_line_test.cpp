// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/robust_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::calibration {
namespace {

/// Points of y = 2 + 0.1 x with noise of 0.05, of which every third or so lies far above.
std::vector<Point> points_with_outliers(std::size_t every) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  std::vector<Point> points;
  for (std::size_t k = 0; k < 300; ++k) {
    const double x = random.uniform(-20.0, 20.0);
    const double outlier = every > 0 && k % every == 0 ? random.uniform(0.5, 50.0) : 0.0;
    points.push_back({x, 2.0 + 0.1 * x + 0.05 * random.normal() + outlier});
  }
  return points;
}

TEST(RobustLine, finds_the_line_of_the_majority) {
  const RobustLine clean = fit_robust_line(points_with_outliers(0), true, 1e-3);
  const RobustLine dirty = fit_robust_line(points_with_outliers(3), true, 1e-3);
  for (const RobustLine& line : {clean, dirty}) {
    EXPECT_NEAR(line.level, 2.0, 0.015);
    EXPECT_NEAR(line.slope, 0.1, 0.0015);
    EXPECT_NEAR(line.deviation, 0.05, 0.01);
  }
}

TEST(RobustLine, is_the_mean_of_readings_that_noise_moves_by_a_count) {
  std::vector<Point> points(100, Point{0.0, 0.0});
  for (std::size_t k = 0; k < 10; ++k) points[10 * k].y = 1.0;
  const RobustLine line = fit_robust_line(points, false, 1.0 / 3);
  EXPECT_NEAR(line.level, 0.1, 1e-12);
  EXPECT_NEAR(line.deviation, 0.3, 1e-12);
}

TEST(RobustLine, of_one_point_is_the_point) {
  const RobustLine line = fit_robust_line(std::vector<Point>{{3.0, 5.0}}, false, 1.0);
  EXPECT_EQ(line.level, 5.0);
  EXPECT_EQ(line.slope, 0.0);
  EXPECT_EQ(line.deviation, 0.0);
}

}  // namespace
}  // namespace dermis::learn::calibration
