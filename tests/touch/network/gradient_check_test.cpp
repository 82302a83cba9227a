// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "support/gradient_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace dermis::support {
namespace {

/// Two smooth residuals of three parameters; `error` is added to the entry [1, 2] of the Jacobian.
touch::network::ResidualFunction with_error(double error) {
  return [error](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    r[0] = p[0] * p[1] + 50.0 * p[2];
    r[1] = std::sin(p[0]) + std::exp(p[2]);
    if (jacobian.empty()) return;
    const double entries[] = {p[1], p[0], 50.0, std::cos(p[0]), 0.0, std::exp(p[2]) + error};
    std::copy(std::begin(entries), std::end(entries), jacobian.begin());
  };
}

const std::vector<double> kPoint = {0.3, -1.2, -0.5};

TEST(GradientCheck, accepts_a_right_jacobian) {
  EXPECT_LT(jacobian_deviation(with_error(0.0), 2, kPoint), 1e-7);
}

TEST(GradientCheck, accepts_a_right_jacobian_far_from_the_origin) {
  EXPECT_LT(jacobian_deviation(with_error(0.0), 2, std::vector<double>{300.0, -4000.0, 2.0}), 1e-7);
}

TEST(GradientCheck, finds_one_wrong_entry_and_says_how_wrong_it_is) {
  EXPECT_NEAR(jacobian_deviation(with_error(1e-3), 2, kPoint), 1e-3, 1e-7);  // entries below 1: absolute
  EXPECT_NEAR(jacobian_deviation(with_error(-1e-5), 2, kPoint), 1e-5, 1e-7);
}

TEST(GradientCheck, judges_large_entries_by_their_relative_error) {
  const auto residual = [](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    r[0] = 1000.0 * p[0];
    if (!jacobian.empty()) jacobian[0] = 990.0;
  };
  EXPECT_NEAR(jacobian_deviation(residual, 1, std::vector<double>{1.0}), 0.01, 1e-7);
}

TEST(GradientCheck, finds_an_entry_that_is_not_a_number) {
  EXPECT_EQ(jacobian_deviation(with_error(std::nan("")), 2, kPoint), std::numeric_limits<double>::infinity());
}

TEST(GradientCheck, finds_a_wrong_sign) {
  const auto residual = [](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    r[0] = 3.0 * p[0];
    if (!jacobian.empty()) jacobian[0] = -3.0;
  };
  EXPECT_NEAR(jacobian_deviation(residual, 1, std::vector<double>{1.0}), 2.0, 1e-7);
}

}  // namespace
}  // namespace dermis::support
