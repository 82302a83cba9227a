// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "support/reference_array.hpp"

namespace dermis::learn::calibration {
namespace {

using support::reference_array;

constexpr std::size_t kRows = 8;
constexpr std::size_t kCols = 10;

/// Sixty presses: 20 taxels, three weights.
CalibrationPlan sixty_presses() {
  CalibrationPlan plan;
  plan.taxels = taxels_with_stride(reference_array(kRows, kCols), 2);
  plan.weights_n = {1.0, 5.0, 20.0};
  return plan;
}

/// How often the weight that has the fewest presses, and the one that has most, has been pressed.
std::pair<std::size_t, std::size_t> least_and_most(const std::vector<PlannedPress>& presses, std::size_t count) {
  std::map<double, std::size_t> times{{1.0, 0}, {5.0, 0}, {20.0, 0}};
  for (std::size_t k = 0; k < count; ++k) ++times[presses[k].weight_n];
  const auto [least, most] =
      std::minmax_element(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {least->second, most->second};
}

TEST(PressOrder, presses_every_taxel_with_every_weight_once) {
  const std::vector<PlannedPress> presses = spread_presses(sixty_presses(), kCols);
  ASSERT_EQ(presses.size(), 60U);
  std::set<std::pair<std::size_t, double>> seen;
  for (const PlannedPress& press : presses) seen.emplace(press.taxel, press.weight_n);
  EXPECT_EQ(seen.size(), 60U);
}

TEST(PressOrder, covers_the_weights_whenever_a_person_stops) {
  const std::vector<PlannedPress> presses = spread_presses(sixty_presses(), kCols);
  EXPECT_EQ(least_and_most(presses, 6), std::make_pair(std::size_t{2}, std::size_t{2}));
  for (std::size_t count = 6; count <= 60; ++count) {
    const auto [least, most] = least_and_most(presses, count);
    EXPECT_LE(most - least, 5U) << count;  // a run, and one
    EXPECT_LE(most, 2 * least) << count;
  }
}

TEST(PressOrder, covers_the_array_whenever_a_person_stops) {
  const std::vector<PlannedPress> presses = spread_presses(sixty_presses(), kCols);
  std::set<std::size_t> taxels;
  std::set<std::pair<bool, bool>> quarters;
  for (std::size_t k = 0; k < 20; ++k) {
    taxels.insert(presses[k].taxel);
    if (k < 6) quarters.emplace(presses[k].taxel / kCols < kRows / 2, presses[k].taxel % kCols < kCols / 2);
  }
  EXPECT_EQ(taxels.size(), 20U);
  EXPECT_EQ(quarters.size(), 4U);
}

TEST(PressOrder, changes_the_weight_after_some_presses_alone) {
  const std::vector<PlannedPress> presses = spread_presses(sixty_presses(), kCols);
  std::size_t changes = 0;
  for (std::size_t k = 1; k < presses.size(); ++k) changes += presses[k].weight_n != presses[k - 1].weight_n ? 1 : 0;
  EXPECT_LE(changes, 20U);
}

TEST(PressOrder, of_a_large_plan_is_whole) {
  CalibrationPlan plan;
  plan.taxels = taxels_with_stride(reference_array(90, 91), 1);
  plan.weights_n = {5.0};
  EXPECT_EQ(spread_presses(plan, 91).size(), 8190U);
}

}  // namespace
}  // namespace dermis::learn::calibration
