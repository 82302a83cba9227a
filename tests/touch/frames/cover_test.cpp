// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/cover.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "dermis/touch/frames/array_description.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

ArrayDescription covered(double spread_m) {
  ArrayDescription array = support::reference_circuit(9, 11);
  array.row_pitch_m = array.col_pitch_m = 0.010;
  array.cover = Cover{spread_m, {}};
  return array;
}

std::vector<double> felt_of(const ArrayDescription& array, std::size_t taxel) {
  std::vector<double> surface(array.taxel_count());
  surface[taxel] = 10.0;
  std::vector<double> felt(surface.size());
  CoverKernel(array).spread(std::span<const double>(surface), std::span<double>(felt));
  return felt;
}

TEST(Cover, hands_on_the_whole_weight_inside_the_rim) {
  const std::vector<double> felt = felt_of(covered(0.005), 4 * 11 + 5);
  EXPECT_NEAR(std::reduce(felt.begin(), felt.end()), 10.0, 1e-4);
  EXPECT_NEAR(felt[4 * 11 + 5], 10.0 * 0.68269 * 0.68269, 1e-3);
  EXPECT_NEAR(felt[4 * 11 + 6], 10.0 * 0.68269 * 0.15730, 1e-3);
  EXPECT_DOUBLE_EQ(felt[3 * 11 + 6], felt[5 * 11 + 4]);
}

TEST(Cover, loses_what_falls_beyond_the_rim) {
  const std::vector<double> felt = felt_of(covered(0.005), 0);
  EXPECT_NEAR(std::reduce(felt.begin(), felt.end()), 10.0 * 0.84134 * 0.84134, 1e-2);
}

TEST(Cover, without_one_the_taxels_feel_what_stands_on_them) {
  ArrayDescription array = covered(0.0);
  EXPECT_DOUBLE_EQ(felt_of(array, 7)[7], 10.0);
  array.cover.reset();
  EXPECT_DOUBLE_EQ(felt_of(array, 7)[7], 10.0);
  EXPECT_EQ(CoverKernel(array).row_reach(), 0U);
}

TEST(Cover, of_shares_spreads_as_they_say) {
  ArrayDescription array = covered(0.0);
  array.cover->shares = {{0, 0, 0.5}, {0, 1, 0.1}, {1, 0, 0.1}, {1, 1, 0.025}};
  ASSERT_TRUE(array.validate());
  const std::vector<double> felt = felt_of(array, 4 * 11 + 5);
  EXPECT_DOUBLE_EQ(felt[4 * 11 + 5], 5.0);
  EXPECT_DOUBLE_EQ(felt[3 * 11 + 5], 1.0);
  EXPECT_DOUBLE_EQ(felt[3 * 11 + 4], 0.25);
  EXPECT_NEAR(CoverKernel(array).row_spread_m(), gaussian_spread(0.7) * 0.010, 1e-9);
}

TEST(Cover, gaussian_spread_is_the_inverse_of_the_share_at_the_centre) {
  for (const double pitches : {0.2, 0.5, 1.0, 3.0}) {
    EXPECT_NEAR(gaussian_spread(gaussian_share(pitches, 0)), pitches, 1e-6);
  }
}

TEST(Cover, that_gives_more_than_it_gets_is_refused) {
  ArrayDescription array = covered(-0.001);
  EXPECT_FALSE(array.validate());
  array.cover = Cover{0.0, {{0, 0, 0.5}, {1, 1, 0.2}}};
  EXPECT_FALSE(array.validate());
  array.cover = Cover{0.0, {{1, 1, 0.2}}};
  EXPECT_FALSE(array.validate());
  array.cover = Cover{};
  EXPECT_TRUE(array.validate());
  EXPECT_TRUE(array.cover->is_unknown());
}

}  // namespace
}  // namespace dermis
