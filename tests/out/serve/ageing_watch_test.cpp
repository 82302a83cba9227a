// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/ageing_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "out/serve/named_touches.hpp"
#include "out/serve/small_suit.hpp"

namespace dermis::out::serve {
namespace {

TEST(AgeingWatch, counts_the_touches_of_each_array_until_it_has_another_model) {
  const std::atomic<bool> stop = false;
  const ServedSuit suit = small_suit({"chest", "back"}, stop);
  AgeingWatch watch(suit);
  for (const float newtons : {5.0F, 0.0F, 5.0F, 0.0F}) {
    const ForceFrame force = force_frame(Nanos{}, std::vector<float>(kRows * kCols, newtons));
    watch.add({1, {}, {}, force, {}, {}});
  }
  constexpr std::size_t kSquares = (kRows - 1) * (kCols - 1);
  EXPECT_EQ(watch.evidence(0).comparisons, 0U);
  EXPECT_EQ(watch.evidence(1).comparisons, 2 * kSquares);
  watch.begin_anew(1, *suit.arrays[1].model);
  EXPECT_EQ(watch.evidence(1).comparisons, 0U);
}

}  // namespace
}  // namespace dermis::out::serve
