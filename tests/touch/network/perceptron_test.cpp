// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/gradient_check.hpp"

namespace dermis::touch::network {
namespace {

const std::vector<PerceptronShape> kShapes = {{1, 1, 0}, {1, 0, 1}, {2, 1, 2},  {2, 4, 0}, {3, 0, 0},
                                              {3, 5, 2}, {4, 3, 4}, {5, 64, 1}, {7, 2, 3}};

std::vector<double> random_values(std::size_t count, double scale, Random& random) {
  std::vector<double> values(count);
  for (double& value : values) value = scale * random.normal();
  return values;
}

testing::Message describe(const PerceptronShape& shape) {
  return testing::Message() << shape.inputs << "-" << shape.hidden << "-1, " << shape.rising_inputs << " rising";
}

/// y from the flat vector as the header orders it, without the index functions of the shape.
double read_in_order(const PerceptronShape& shape, const std::vector<double>& parameters,
                     const std::vector<double>& x) {
  auto next = parameters.begin();
  std::vector<double> activations;
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    double sum = *next++;
    for (const double value : x) sum += *next++ * value;
    activations.push_back(1.0 / (1.0 + std::exp(-sum)));
  }
  double y = *next++;
  for (const double activation : activations) y += *next++ * activation;
  for (const double value : x) y += *next++ * value;
  return y;
}

TEST(Perceptron, parameters_are_laid_out_without_gap_or_overlap) {
  for (const PerceptronShape& shape : kShapes) {
    SCOPED_TRACE(describe(shape));
    std::vector<std::size_t> places = {shape.output_bias()};
    for (std::size_t input = 0; input < shape.inputs; ++input) places.push_back(shape.direct_weight(input));
    for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
      places.push_back(shape.bias(unit));
      places.push_back(shape.output_weight(unit));
      for (std::size_t input = 0; input < shape.inputs; ++input) places.push_back(shape.weight(unit, input));
    }
    const std::set<std::size_t> distinct(places.begin(), places.end());
    EXPECT_EQ(places.size(), shape.parameter_count());
    EXPECT_EQ(distinct.size(), shape.parameter_count());
    EXPECT_EQ(*distinct.rbegin(), shape.parameter_count() - 1);
  }
}

TEST(Perceptron, sigmoid_has_its_known_values) {
  EXPECT_EQ(sigmoid(0.0), 0.5);
  EXPECT_NEAR(sigmoid(std::log(3.0)), 0.75, 1e-15);
  EXPECT_NEAR(sigmoid(-std::log(3.0)), 0.25, 1e-15);
  for (double sum = -30.0; sum <= 30.0; sum += 0.37) EXPECT_NEAR(sigmoid(sum) + sigmoid(-sum), 1.0, 1e-15) << sum;
  EXPECT_EQ(sigmoid(1e3), 1.0);
  EXPECT_EQ(sigmoid(-1e3), 0.0);
}

TEST(Perceptron, output_is_the_one_computed_by_hand) {
  // One hidden unit: its sum is 0.5 + 1 * 2 - 2 * 1 = 0.5, its activation 0.62245933...
  const std::vector<double> parameters = {0.5, 1.0, -2.0, 0.25, 3.0, 0.1, -0.2};
  const std::vector<double> x = {2.0, 1.0};
  EXPECT_NEAR(output({2, 1, 0}, parameters, x), 0.25 + 3.0 * 0.6224593312018546 + 0.1 * 2.0 - 0.2 * 1.0, 1e-15);
}

TEST(Perceptron, without_hidden_units_output_is_linear) {
  const std::vector<double> parameters = {0.5, 2.0, -3.0};
  EXPECT_NEAR(output({2, 0, 0}, parameters, std::vector<double>{4.0, 1.5}), 0.5 + 8.0 - 4.5, 1e-15);
}

TEST(Perceptron, output_follows_the_documented_order_of_parameters) {
  for (const PerceptronShape& shape : kShapes) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(describe(shape) << ", seed " << seed);
      Random random(seed);
      const auto parameters = random_values(shape.parameter_count(), 2.0, random);
      const auto x = random_values(shape.inputs, 3.0, random);
      EXPECT_NEAR(output(shape, parameters, x), read_in_order(shape, parameters, x), 1e-12);
    }
  }
}

TEST(Perceptron, gradient_agrees_with_finite_differences) {
  for (const PerceptronShape& shape : kShapes) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(describe(shape) << ", seed " << seed);
      Random random(seed);
      const auto x = random_values(shape.inputs, 1.0, random);
      const auto residual = [&](std::span<const double> parameters, std::span<double> y, std::span<double> jacobian) {
        y[0] = jacobian.empty() ? output(shape, parameters, x) : output_and_gradient(shape, parameters, x, jacobian);
      };
      EXPECT_LT(support::jacobian_deviation(residual, 1, random_values(shape.parameter_count(), 1.0, random)), 1e-7);
    }
  }
}

TEST(Perceptron, gradient_is_the_slope_between_nearby_parameters) {
  // The same without gradient_check: one step along a random direction.
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const PerceptronShape shape{3, 4, 0};
  const auto x = random_values(3, 1.0, random);
  const auto parameters = random_values(shape.parameter_count(), 1.0, random);
  const auto direction = random_values(shape.parameter_count(), 1.0, random);
  std::vector<double> gradient(shape.parameter_count());
  const double y = output_and_gradient(shape, parameters, x, gradient);
  EXPECT_NEAR(y, output(shape, parameters, x), 1e-14);
  constexpr double kStep = 1e-5;
  std::vector<double> ahead = parameters;
  std::vector<double> behind = parameters;
  double slope = 0.0;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    ahead[k] += kStep * direction[k];
    behind[k] -= kStep * direction[k];
    slope += gradient[k] * direction[k];
  }
  EXPECT_NEAR((output(shape, ahead, x) - output(shape, behind, x)) / (2.0 * kStep), slope, 1e-8);
}

TEST(Perceptron, sums_of_a_thousand_saturate_without_losing_the_gradient) {
  const PerceptronShape shape{1, 1, 0};
  for (const double sum : {-1e3, 1e3}) {
    const std::vector<double> parameters = {sum, 0.0, 0.5, 2.0, 0.0};
    std::vector<double> gradient(parameters.size());
    const double y = output_and_gradient(shape, parameters, std::vector<double>{3.0}, gradient);
    EXPECT_EQ(y, sum > 0.0 ? 2.5 : 0.5);
    EXPECT_EQ(gradient, (std::vector<double>{0.0, 0.0, 1.0, sum > 0.0 ? 1.0 : 0.0, 3.0}));
  }
}

TEST(MonotonePerceptron, output_rises_with_its_rising_inputs) {
  for (const PerceptronShape& shape : kShapes) {
    if (shape.rising_inputs == 0) continue;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      SCOPED_TRACE(describe(shape) << ", seed " << seed);
      Random random(seed);
      std::vector<double> parameters(shape.parameter_count());
      monotone::parameters(shape, random_values(shape.parameter_count(), 2.0, random), parameters);
      auto x = random_values(shape.inputs, 2.0, random);
      for (int k = 0; k < 20; ++k) {
        const double before = output(shape, parameters, x);
        x[random.below(shape.rising_inputs)] += random.log_uniform(1e-3, 3.0);
        EXPECT_GT(output(shape, parameters, x), before);
      }
    }
  }
}

TEST(MonotonePerceptron, output_is_free_to_fall_with_the_other_inputs) {
  const PerceptronShape shape{2, 1, 1};
  std::vector<double> parameters(shape.parameter_count());
  std::vector<double> free(shape.parameter_count(), 0.0);
  free[shape.weight(0, 1)] = -1.0;
  free[shape.direct_weight(1)] = -1.0;
  monotone::parameters(shape, free, parameters);
  EXPECT_LT(output(shape, parameters, std::vector<double>{0.0, 1.0}),
            output(shape, parameters, std::vector<double>{0.0, 0.0}));
}

TEST(MonotonePerceptron, exactly_the_weights_of_rising_inputs_and_the_output_weights_are_positive) {
  for (const PerceptronShape& shape : kShapes) {
    SCOPED_TRACE(describe(shape));
    std::set<std::size_t> positive;
    for (std::size_t input = 0; input < shape.rising_inputs; ++input) {
      positive.insert(shape.direct_weight(input));
      for (std::size_t unit = 0; unit < shape.hidden; ++unit) positive.insert(shape.weight(unit, input));
    }
    for (std::size_t unit = 0; unit < shape.hidden && shape.rising_inputs > 0; ++unit) {
      positive.insert(shape.output_weight(unit));
    }
    Random random(3);
    const auto free = random_values(shape.parameter_count(), 1.0, random);
    std::vector<double> parameters(free.size());
    monotone::parameters(shape, free, parameters);
    for (std::size_t k = 0; k < free.size(); ++k) {
      EXPECT_EQ(monotone::is_positive(shape, k), positive.contains(k)) << "parameter " << k;
      EXPECT_EQ(parameters[k], positive.contains(k) ? std::exp(free[k]) : free[k]) << "parameter " << k;
    }
  }
}

TEST(MonotonePerceptron, free_values_can_become_parameters_in_place) {
  const PerceptronShape shape{2, 2, 2};
  Random random(4);
  std::vector<double> values = random_values(shape.parameter_count(), 1.0, random);
  std::vector<double> parameters(values.size());
  monotone::parameters(shape, values, parameters);
  monotone::parameters(shape, values, values);
  EXPECT_EQ(values, parameters);
}

TEST(MonotonePerceptron, chained_gradient_agrees_with_finite_differences) {
  for (const PerceptronShape& shape : kShapes) {
    SCOPED_TRACE(describe(shape));
    Random random(5);
    const auto x = random_values(shape.inputs, 1.0, random);
    const auto residual = [&](std::span<const double> free, std::span<double> y, std::span<double> jacobian) {
      std::vector<double> parameters(free.size());
      monotone::parameters(shape, free, parameters);
      if (jacobian.empty()) {
        y[0] = output(shape, parameters, x);
        return;
      }
      y[0] = output_and_gradient(shape, parameters, x, jacobian);
      monotone::chain_gradient(shape, parameters, jacobian);
    };
    EXPECT_LT(support::jacobian_deviation(residual, 1, random_values(shape.parameter_count(), 0.7, random)), 1e-7);
  }
}

}  // namespace
}  // namespace dermis::touch::network
