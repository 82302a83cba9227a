// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/equal_presses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dermis::touch::compensation {
namespace {

constexpr PressComparison kScattered{.equal = 0, .more = 2, .less = 2};
constexpr PressComparison kEqual{.equal = 4};

TEST(EqualPresses, equality_says_nothing_until_taxels_are_seen_to_scatter) {
  EqualPresses presses;
  EXPECT_EQ(presses.evidence(5), 0.0);
  for (int press = 0; press < 20; ++press) presses.add({.equal = 1, .more = 5});  // as a slanted edge makes them
  EXPECT_EQ(presses.evidence(5), 0.0);
  for (int press = 0; press < 20; ++press) presses.add(kScattered);
  EXPECT_GT(presses.evidence(2), 4.0);
  EXPECT_EQ(presses.evidence(0), 0.0);
}

TEST(EqualPresses, presses_that_are_equal_everywhere_limit_what_one_press_says) {
  EqualPresses presses;
  for (int press = 0; press < 60; ++press) presses.add(kScattered);
  for (int press = 0; press < 20; ++press) presses.add(kEqual);
  EXPECT_NEAR(presses.evidence(20), std::log(81.0 / 21.0), 1e-9);
}

TEST(EqualPresses, few_presses_that_are_equal_everywhere_are_chance) {
  EqualPresses presses;
  for (int press = 0; press < 300; ++press) {
    presses.add(kScattered);
    presses.add({.equal = press % 50 == 0 ? 2 : 0, .more = press % 50 == 0 ? 0 : 2});
  }
  EXPECT_GT(presses.evidence(5), 20.0);
}

TEST(EqualPresses, a_pair_of_lines_is_not_its_own_measure) {
  EqualPresses own;
  for (int press = 0; press < 6; ++press) own.add(kEqual);
  EqualPresses all = own;
  for (int press = 0; press < 6; ++press) all.add(kScattered);
  EqualPresses others;
  for (int press = 0; press < 6; ++press) others.add(kScattered);
  EXPECT_LT(all.evidence(4), others.evidence(4));
  EXPECT_EQ(all.without(own).evidence(4), others.evidence(4));
}

/// Alone they were taken for chance; among the others, for a fault.
TEST(EqualPresses, the_others_are_a_measure_though_less_was_expected_of_all_than_of_the_pair) {
  EqualPresses all;
  EqualPresses own;
  for (int press = 0; press < 6; ++press) all.add(kScattered);
  for (int press = 0; press < 2; ++press) {
    all.add(kEqual);
    own.add(kEqual);
  }
  EXPECT_NEAR(all.without(own).evidence(4), 4.0 * std::log(26.0 / 2.0), 1e-9);
}

}  // namespace
}  // namespace dermis::touch::compensation
