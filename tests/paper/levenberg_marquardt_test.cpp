// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/training/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "dermis/touch/frames/random.hpp"

namespace dermis::paper {
namespace {

TEST(NetworkLevenbergMarquardt, follows_the_path_of_the_residual_function) {
  const NetworkShape shape{2, {{4, Activation::log_sigmoid}, {2, Activation::linear}}};
  Random random(11);
  std::vector<double> inputs(60);
  std::vector<double> targets(60);
  std::vector<double> weights(30);
  std::vector<double> start(shape.parameter_count());
  for (double& value : inputs) value = random.normal();
  for (double& value : targets) value = random.normal();
  for (double& value : weights) value = random.uniform(0.1, 2.0);
  for (double& value : start) value = random.normal();

  FeedForward<double> network(shape);
  // Residuals sqrt(w) (o - t), their Jacobian by differences of order 4: about 10 digits.
  const auto residuals = [&](std::span<const double> p, std::span<double> r) {
    network.evaluate(p, inputs, r);
    for (std::size_t k = 0; k < r.size(); ++k) r[k] = std::sqrt(weights[k / 2]) * (r[k] - targets[k]);
  };
  const touch::network::ResidualFunction function = [&](std::span<const double> p, std::span<double> r,
                                                        std::span<double> jacobian) {
    residuals(p, r);
    if (jacobian.empty()) return;
    std::vector<double> moved(p.begin(), p.end());
    std::vector<double> at(r.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
      for (std::size_t i = 0; i < r.size(); ++i) jacobian[i * p.size() + k] = 0.0;
      for (const double steps : {-2.0, -1.0, 1.0, 2.0}) {
        constexpr double kStep = 1e-3;
        moved[k] = p[k] + steps * kStep;
        residuals(moved, at);
        const double share = (std::abs(steps) == 1.0 ? 8.0 : -1.0) * (steps > 0.0 ? 1.0 : -1.0) / (12.0 * kStep);
        for (std::size_t i = 0; i < r.size(); ++i) jacobian[i * p.size() + k] += share * at[i];
      }
      moved[k] = p[k];
    }
  };

  const touch::network::LevenbergMarquardtOptions options{.max_iterations = 8};
  std::vector<double> by_residuals = start;
  const auto expected = touch::network::minimise(function, 60, by_residuals, options);
  std::vector<double> by_network = start;
  const PackedSamples<double> samples(shape, {30, inputs, targets, weights});
  const auto report = minimise(network, samples, by_network, options);
  EXPECT_NEAR(report.initial_error / expected.initial_error, 1.0, 1e-12);
  EXPECT_NEAR(report.final_error / expected.final_error, 1.0, 1e-6);
  EXPECT_LT(report.final_error, 0.8 * report.initial_error);
  for (std::size_t k = 0; k < start.size(); ++k) EXPECT_NEAR(by_network[k], by_residuals[k], 1e-5) << "parameter " << k;
}

}  // namespace
}  // namespace dermis::paper
