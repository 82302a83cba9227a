// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/samples.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace dermis::paper {
namespace {

/// Three patterns for two inputs and one output.
template <typename Real>
struct Patterns {
  std::vector<Real> inputs = {1, 2, 3, 4, 5, 6};
  std::vector<Real> targets = {1, 0, 1};
  std::vector<Real> weights = {};
  std::size_t count = 3;

  [[nodiscard]] std::string complaint() const {
    const Status status = check_samples<Real>({count, inputs, targets, weights}, 2, 1);
    return status ? "" : status.error().message;
  }
};

template <typename Real>
class CheckSamples : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(CheckSamples, Precisions);

TYPED_TEST(CheckSamples, accepts_patterns_with_and_without_weights) {
  Patterns<TypeParam> patterns;
  EXPECT_EQ(patterns.complaint(), "");
  patterns.weights = {0, 0, 1};
  EXPECT_EQ(patterns.complaint(), "");
}

TYPED_TEST(CheckSamples, wants_a_pattern) {
  EXPECT_EQ((Patterns<TypeParam>{{}, {}, {}, 0}.complaint()), "samples: there is no pattern");
}

TYPED_TEST(CheckSamples, wants_sizes_that_fit_the_network) {
  Patterns<TypeParam> patterns;
  patterns.inputs.pop_back();
  EXPECT_EQ(patterns.complaint(),
            "samples: 3 patterns for a network of 2 inputs and 1 outputs come with 5 inputs and 3 targets");
  patterns = {};
  patterns.targets.push_back(1);
  EXPECT_EQ(patterns.complaint(),
            "samples: 3 patterns for a network of 2 inputs and 1 outputs come with 6 inputs and 4 targets");
  patterns = {};
  patterns.weights = {1, 1};
  EXPECT_EQ(patterns.complaint(), "samples: the weights must be one a pattern or none");
}

TYPED_TEST(CheckSamples, names_the_first_value_that_is_not_finite) {
  for (const TypeParam bad : {std::numeric_limits<TypeParam>::quiet_NaN(), std::numeric_limits<TypeParam>::infinity(),
                              -std::numeric_limits<TypeParam>::infinity()}) {
    Patterns<TypeParam> patterns;
    patterns.inputs[3] = bad;
    patterns.inputs[5] = bad;
    EXPECT_EQ(patterns.complaint(), "samples: input 1 of pattern 1 is not a finite number");
    patterns = {};
    patterns.targets[2] = bad;
    EXPECT_EQ(patterns.complaint(), "samples: target 0 of pattern 2 is not a finite number");
    patterns = {};
    patterns.weights = {1, bad, 1};
    EXPECT_EQ(patterns.complaint(), "samples: weight 0 of pattern 1 is not a finite number");
  }
}

TYPED_TEST(CheckSamples, wants_weights_that_count) {
  Patterns<TypeParam> patterns;
  patterns.weights = {1, static_cast<TypeParam>(-0.5), 1};
  EXPECT_EQ(patterns.complaint(), "samples: a weight is negative");
  patterns.weights = {0, 0, 0};
  EXPECT_EQ(patterns.complaint(), "samples: all weights are 0");
}

}  // namespace
}  // namespace dermis::paper
