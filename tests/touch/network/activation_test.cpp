// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/activation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::touch::network {
namespace {

constexpr Activation kActivations[] = {Activation::log_sigmoid, Activation::tanh, Activation::relu, Activation::linear};

TEST(Activation, has_a_name) {
  EXPECT_EQ(name(Activation::log_sigmoid), "log_sigmoid");
  EXPECT_EQ(name(Activation::tanh), "tanh");
  EXPECT_EQ(name(Activation::relu), "relu");
  EXPECT_EQ(name(Activation::linear), "linear");
}

TEST(Activation, log_sigmoid_is_eq_3) {
  EXPECT_EQ(activate(Activation::log_sigmoid, 0.0), 0.5);
  // The paper keeps sums within -ln 3 and ln 3, where outputs are 0.25 and 0.75.
  EXPECT_NEAR(activate(Activation::log_sigmoid, std::log(3.0)), 0.75, 1e-16);
  EXPECT_NEAR(activate(Activation::log_sigmoid, -std::log(3.0)), 0.25, 1e-16);
  for (double x = -30.0; x <= 30.0; x += 0.25) {
    EXPECT_NEAR(activate(Activation::log_sigmoid, x) + activate(Activation::log_sigmoid, -x), 1.0, 1e-15) << x;
  }
}

TEST(Activation, tanh_is_a_log_sigmoid_stretched_to_both_signs) {
  for (double x = -20.0; x <= 20.0; x += 0.25) {
    EXPECT_NEAR(activate(Activation::tanh, x), 2.0 * activate(Activation::log_sigmoid, 2.0 * x) - 1.0, 1e-15) << x;
  }
}

TEST(Activation, relu_and_linear) {
  EXPECT_EQ(activate(Activation::relu, -2.5), 0.0);
  EXPECT_EQ(activate(Activation::relu, 2.5), 2.5);
  EXPECT_EQ(activate(Activation::linear, -2.5), -2.5);
}

TEST(Activation, nan_stays_nan) {
  for (const Activation activation : kActivations) {
    EXPECT_TRUE(std::isnan(activate(activation, std::numeric_limits<double>::quiet_NaN()))) << name(activation);
    EXPECT_TRUE(std::isnan(activate(activation, std::numeric_limits<float>::quiet_NaN()))) << name(activation);
  }
}

TEST(Activation, slope_is_the_derivative) {
  constexpr double kStep = 1e-5;
  for (const Activation activation : kActivations) {
    for (const double x : {-8.0, -2.0, -0.5, 0.3, 1.0, 7.0}) {
      const double difference = (activate(activation, x + kStep) - activate(activation, x - kStep)) / (2.0 * kStep);
      EXPECT_NEAR(slope_from_output(activation, activate(activation, x)), difference, 1e-9) << name(activation) << x;
    }
  }
}

TEST(Activation, slope_of_relu_is_0_at_0) {
  EXPECT_EQ(slope_from_output(Activation::relu, 0.0), 0.0);
}

template <typename Real>
void expect_finite_everywhere() {
  for (const Activation activation : kActivations) {
    for (const Real x : {Real{1e4}, static_cast<Real>(1e30), std::numeric_limits<Real>::max()}) {
      for (const Real sum : {x, -x}) {
        const Real y = activate(activation, sum);
        EXPECT_TRUE(std::isfinite(y)) << name(activation) << " of " << sum;
        EXPECT_EQ(slope_from_output(activation, y),
                  activation == Activation::linear || (activation == Activation::relu && sum > 0) ? Real{1} : Real{0});
      }
    }
  }
}

TEST(Activation, is_finite_for_every_finite_sum) {
  expect_finite_everywhere<float>();
  expect_finite_everywhere<double>();
}

}  // namespace
}  // namespace dermis::touch::network
