// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/standardisation.hpp"

#include <gtest/gtest.h>

namespace dermis::learn::recognition {
namespace {

TEST(Standardisation, leaves_out_columns_whose_spread_a_float_of_their_mean_does_not_resolve) {
  constexpr double kMean = 1e6;
  Matrix features(2, 3);
  features << kMean - 0.1, kMean - 10.0, 5.0,  //
      kMean + 0.1, kMean + 10.0, 5.0;
  const Standardisation standardisation = standardisation_of(features, {0, 1}, {0, 1, 2});
  EXPECT_EQ(standardisation.columns, (std::vector<std::size_t>{1}));
}

}  // namespace
}  // namespace dermis::learn::recognition
