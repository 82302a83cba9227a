// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/rehearsing_hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <set>
#include <vector>

namespace dermis::live::sources {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr std::size_t kTaxels = 20;
constexpr std::size_t kPresses = 400;

const std::vector<double> kNothing(kTaxels);
const GuideWords kSingle = {.press = true, .taxel = 7, .weight_n = 5.0, .hold_time = 1s};
const GuideWords kPair = {.press = true, .taxel = 7, .weight_n = 5.0, .together_with = 13, .hold_time = 1s};

GuideWords wrong(GuideWords words) {
  words.is_wrong = true;
  return words;
}

/// 5 N on each of these taxels.
std::vector<double> on(const std::vector<std::size_t>& taxels) {
  std::vector<double> force_n(kTaxels);
  for (const std::size_t taxel : taxels) force_n[taxel] = 5.0;
  return force_n;
}

/// What lies on the array after the hand heard the words for so long.
std::vector<double> after(RehearsingHand& hand, const GuideWords& words, std::chrono::milliseconds time) {
  std::vector<double> force_n;
  for (std::int64_t i = 0; i < time.count() / 10; ++i) force_n = hand.move(words, 0.01);
  return force_n;
}

/// What a hand does that is asked for the same press again and again.
std::vector<std::vector<double>> presses(RehearsingHand& hand, const GuideWords& words) {
  std::vector<std::vector<double>> presses;
  while (presses.size() < kPresses) {
    presses.push_back(after(hand, words, 1100ms));
    EXPECT_EQ(after(hand, {.hold_time = 1s}, 600ms), kNothing);
  }
  return presses;
}

/// A hand of a seed whose first two presses are right.
RehearsingHand steady_hand() {
  for (std::uint64_t seed = 1;; ++seed) {
    RehearsingHand hand(kTaxels, seed);
    const auto first = presses(hand, kSingle);
    if (first[0] == on({7}) && first[1] == on({7})) return {kTaxels, seed};
  }
}

TEST(RehearsingHand, presses_nothing_unless_asked) {
  RehearsingHand hand(kTaxels, 1);
  EXPECT_EQ(after(hand, {}, 5s), kNothing);
}

TEST(RehearsingHand, puts_the_weight_on_after_a_hold_and_takes_it_off_when_told) {
  RehearsingHand hand = steady_hand();
  EXPECT_EQ(after(hand, kSingle, 900ms), kNothing);
  EXPECT_EQ(after(hand, kSingle, 200ms), on({7}));
  EXPECT_EQ(after(hand, kSingle, 10s), on({7}));
  EXPECT_EQ(after(hand, {.hold_time = 1s}, 400ms), on({7}));
  EXPECT_EQ(after(hand, {.hold_time = 1s}, 200ms), kNothing);
}

TEST(RehearsingHand, puts_as_much_on_both_taxels_of_a_pair) {
  RehearsingHand hand = steady_hand();
  EXPECT_EQ(after(hand, kPair, 2s), on({7, 13}));
}

TEST(RehearsingHand, begins_one_single_press_of_eight_beside_or_with_one_more) {
  RehearsingHand hand(kTaxels, 5);
  const auto done = presses(hand, kSingle);
  EXPECT_EQ(std::set(done.begin(), done.end()), (std::set{on({7}), on({8}), on({7, 8})}));
  const auto wrong_ones = static_cast<std::size_t>(
      std::count_if(done.begin(), done.end(), [](const auto& press) { return press != on({7}); }));
  EXPECT_NEAR(static_cast<double>(wrong_ones), kPresses / 8.0, 20.0);
}

TEST(RehearsingHand, begins_pairs_beside_one_of_them_with_one_more_or_without_one) {
  RehearsingHand hand(kTaxels, 5);
  const auto done = presses(hand, kPair);
  EXPECT_EQ(std::set(done.begin(), done.end()),
            (std::set{on({7, 13}), on({8, 13}), on({7, 14}), on({7, 8, 13}), on({7, 13, 14}), on({7}), on({13})}));
}

TEST(RehearsingHand, does_not_see_its_mistake_until_it_is_told_and_then_begins_anew) {
  RehearsingHand hand(kTaxels, 5);
  std::vector<double> force_n = after(hand, kPair, 1100ms);
  while (force_n == on({7, 13})) {
    ASSERT_EQ(after(hand, {.hold_time = 1s}, 600ms), kNothing);
    force_n = after(hand, kPair, 1100ms);
  }
  EXPECT_EQ(after(hand, kPair, 10s), force_n);
  while (force_n != on({7, 13})) {
    EXPECT_EQ(after(hand, wrong(kPair), 100ms), kNothing);
    force_n = after(hand, kPair, 1100ms);
  }
}

TEST(RehearsingHand, leaves_a_mistake_on_for_as_long_as_a_page_needs_to_show_it) {
  RehearsingHand hand = steady_hand();
  EXPECT_EQ(after(hand, kSingle, 1100ms), on({7}));
  EXPECT_EQ(after(hand, wrong(kSingle), 1400ms), on({7}));
  EXPECT_EQ(after(hand, wrong(kSingle), 200ms), kNothing);
}

TEST(RehearsingHand, errs_as_its_seed_tells) {
  RehearsingHand first(kTaxels, 5);
  RehearsingHand same(kTaxels, 5);
  RehearsingHand other(kTaxels, 6);
  const auto done = presses(first, kPair);
  EXPECT_EQ(done, presses(same, kPair));
  EXPECT_NE(done, presses(other, kPair));
}

TEST(RehearsingHand, does_not_press_beside_the_array) {
  RehearsingHand hand(kTaxels, 1);
  EXPECT_EQ(after(hand, {.press = true, .taxel = kTaxels, .weight_n = 5.0, .hold_time = 1s}, 3s), kNothing);
}

}  // namespace
}  // namespace dermis::live::sources
