// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/touch_finder.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/touch/frames/random.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kTaxels = 12;
constexpr std::uint64_t kSeed = 5;

/// Readings of 100 counts with a noise of 1.
std::vector<float> at_rest(Random& random) {
  std::vector<float> counts(kTaxels);
  for (float& count : counts) count = 100.0F + static_cast<float>(random.normal());
  return counts;
}

TouchFinder rested(Random& random) {
  TouchFinder finder(kTaxels);
  while (!finder.is_ready()) finder.add(at_rest(random));
  return finder;
}

TEST(TouchFinder, sees_nothing_in_the_noise) {
  Random random(kSeed);
  TouchFinder finder = rested(random);
  for (int i = 0; i < 1000; ++i) {
    finder.add(at_rest(random));
    ASSERT_FALSE(finder.touched()) << "frame " << i << " of seed " << kSeed;
  }
}

TEST(TouchFinder, finds_the_reading_that_has_moved_farthest) {
  Random random(kSeed);
  TouchFinder finder = rested(random);
  std::vector<float> counts = at_rest(random);
  counts[4] += 200.0F;
  counts[5] += 350.0F;  // the touched one beside its ghost
  finder.add(counts);
  EXPECT_EQ(finder.touched(), 5U);
  finder.add(at_rest(random));
  EXPECT_FALSE(finder.touched());
}

TEST(TouchFinder, finds_a_reading_that_falls_where_it_is_pressed) {
  Random random(kSeed);
  TouchFinder finder = rested(random);
  std::vector<float> counts = at_rest(random);
  counts[11] -= 60.0F;
  finder.add(counts);
  EXPECT_EQ(finder.touched(), 11U);
}

TEST(TouchFinder, leaves_out_readings_that_are_missing) {
  constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
  TouchFinder finder(2);
  while (!finder.is_ready()) finder.add(std::vector<float>{kMissing, 50.0F});
  finder.add(std::vector<float>{900.0F, 90.0F});
  EXPECT_EQ(finder.touched(), 1U) << "the first has no rest to move from";
  finder.add(std::vector<float>{kMissing, kMissing});
  EXPECT_FALSE(finder.touched());
}

}  // namespace
}  // namespace dermis::out::serve
