// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/network_bank.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dermis/core/random.hpp"
#include "dermis/network/feed_forward.hpp"

namespace dermis::network {
namespace {

std::vector<float> random_values(std::size_t count, double scale, Random& random) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(scale * random.normal());
  return values;
}

std::vector<double> widened(std::span<const float> values) {
  return {values.begin(), values.end()};
}

/// Parameters for sums of the order of 1.
std::vector<float> random_parameters(const NetworkShape& shape, Random& random) {
  std::vector<float> parameters;
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    const auto fan_in = static_cast<double>(shape.fan_in(layer));
    const auto own =
        random_values(shape.layers[layer].units * (shape.fan_in(layer) + 1), 1.0 / std::sqrt(fan_in), random);
    parameters.insert(parameters.end(), own.begin(), own.end());
  }
  return parameters;
}

TEST(NetworkBank, the_bank_of_the_paper_has_33751296_unknowns) {
  const Layer wide{256, Activation::log_sigmoid};
  const NetworkBank bank({256, {wide, wide, {1, Activation::log_sigmoid}}}, 256);
  EXPECT_EQ(bank.parameter_count(), 33'751'296U);
}

TEST(NetworkBank, every_network_gives_what_it_gives_alone) {
  const NetworkShape shape{3, {{17, Activation::tanh}, {5, Activation::relu}, {2, Activation::log_sigmoid}}};
  Random random(1);
  NetworkBank bank(shape, 7);
  std::vector<std::vector<float>> parameters;
  for (std::size_t network = 0; network < 7; ++network) {
    parameters.push_back(random_parameters(shape, random));
    bank.set_parameters(network, parameters.back());
  }
  const auto inputs = random_values(5 * 3, 1.0, random);
  std::vector<float> outputs(5 * 7 * 2);
  bank.evaluate_batch(inputs, outputs);
  FeedForward<double> alone(shape);
  for (std::size_t network = 0; network < 7; ++network) {
    std::vector<double> expected(5 * 2);
    alone.evaluate(widened(parameters[network]), widened(inputs), expected);
    for (std::size_t p = 0; p < 5; ++p) {
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(outputs[(p * 7 + network) * 2 + k], expected[p * 2 + k], 2e-6);
      }
    }
  }
}

TEST(NetworkBank, gradient_descent_moves_against_the_mean_gradient) {
  const NetworkShape shape{3, {{4, Activation::tanh}, {1, Activation::linear}}};
  Random random(2);
  NetworkBank bank(shape, 1);
  const auto before = random_parameters(shape, random);
  bank.set_parameters(0, before);
  const auto inputs = random_values(8 * 3, 1.0, random);
  const auto targets = random_values(8, 1.0, random);
  const std::vector<std::uint32_t> chosen = {7, 0, 0, 3};
  std::vector<float> error(1);
  bank.train_step({4, inputs, targets, chosen, {}}, {}, error);

  std::vector<double> own_inputs;
  std::vector<double> own_targets;
  for (const std::uint32_t row : chosen) {
    own_inputs.insert(own_inputs.end(), &inputs[row * 3], &inputs[row * 3] + 3);
    own_targets.push_back(double{targets[row]});
  }
  FeedForward<double> alone(shape);
  std::vector<double> gradient(shape.parameter_count());
  const PackedSamples<double> samples(shape, {4, own_inputs, own_targets, {}});
  EXPECT_NEAR(error[0], alone.error_and_gradient(widened(before), samples, gradient) / 4, 1e-6);
  std::vector<float> after(shape.parameter_count());
  bank.parameters(0, after);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i] - 0.1 * gradient[i] / 4, 1e-6);
}

}  // namespace
}  // namespace dermis::network
