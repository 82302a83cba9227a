// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/peaks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace dermis::paper {
namespace {

TEST(Peaks, has_the_values_of_its_equation) {
  // 3/e - 1/(3e) at the origin, by hand; the others from numpy with the formula of MATLAB's documentation.
  EXPECT_NEAR(peaks(0.0, 0.0), 0.98101184312384615, 1e-15);
  EXPECT_NEAR(peaks(1.0, -2.0), -2.1023512845906334, 1e-13);
  EXPECT_NEAR(peaks(-1.5, 0.3), -2.832336861756888, 1e-13);
}

TEST(Peaks, samples_are_the_papers_3721_pairs) {
  const PeaksSamples samples = peaks_samples();
  ASSERT_EQ(samples.inputs.size(), 2U * 3721U);
  ASSERT_EQ(samples.targets.size(), 3721U);
  EXPECT_EQ(samples.inputs[0], -3.0);
  EXPECT_EQ(samples.inputs[1], -3.0);
  EXPECT_EQ(samples.inputs[2], -2.9);
  EXPECT_EQ(samples.inputs.back(), 3.0);
  for (std::size_t p = 0; p < samples.targets.size(); ++p) {
    ASSERT_EQ(samples.targets[p], peaks(samples.inputs[2 * p], samples.inputs[2 * p + 1]));
  }
}

TEST(Peaks, has_the_variance_that_the_literature_gives_and_its_range) {
  const std::vector<double> z = peaks_samples().targets;
  const double mean = std::accumulate(z.begin(), z.end(), 0.0) / 3721.0;
  const double square = std::inner_product(z.begin(), z.end(), z.begin(), 0.0) / 3721.0;
  EXPECT_NEAR(square - mean * mean, 3.52, 0.005);
  const auto [least, greatest] = std::minmax_element(z.begin(), z.end());
  EXPECT_NEAR(*greatest - *least, 14.65, 0.02);
}

}  // namespace
}  // namespace dermis::paper
