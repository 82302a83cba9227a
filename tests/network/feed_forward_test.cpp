// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/feed_forward.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "dermis/network/gradient_check.hpp"

namespace dermis::network {
namespace {

TEST(FeedForward, gradient_and_normal_equations_agree_with_finite_differences) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const NetworkShape shape{3, {{4, Activation::tanh}, {3, Activation::log_sigmoid}, {2, Activation::linear}}};
  FeedForward<double> network(shape);
  std::vector<double> parameters(shape.parameter_count());
  for (double& value : parameters) value = uniform(random);
  std::vector<double> inputs(10 * 3);
  std::vector<double> targets(10 * 2);
  for (double& value : inputs) value = uniform(random);
  for (double& value : targets) value = uniform(random);
  const PackedSamples<double> samples(shape, {10, inputs, targets, {}});
  const auto error = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
    r[0] = jacobian.empty() ? network.error(p, samples) : network.error_and_gradient(p, samples, jacobian);
  };
  EXPECT_LT(jacobian_deviation(error, 1, parameters), 1e-7);
}

}  // namespace
}  // namespace dermis::network
