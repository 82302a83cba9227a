// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron_bank.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/simd_targets.hpp"

namespace dermis::touch::network {
namespace {

std::vector<float> random_values(std::size_t count, double scale, Random& random) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(scale * random.normal());
  return values;
}

/// Entry `lane` of every row of a table [rows, lanes].
std::vector<double> lane_of(const std::vector<float>& table, std::size_t lanes, std::size_t lane) {
  std::vector<double> column;
  for (std::size_t k = lane; k < table.size(); k += lanes) column.push_back(static_cast<double>(table[k]));
  return column;
}

/// The largest sum that rounding can see: |c| + sum |s x| + sum |v|.
double magnitude(const PerceptronShape& shape, const std::vector<double>& parameters, const std::vector<double>& x) {
  double sum = std::abs(parameters[shape.output_bias()]);
  for (std::size_t i = 0; i < shape.inputs; ++i) sum += std::abs(parameters[shape.direct_weight(i)] * x[i]);
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) sum += std::abs(parameters[shape.output_weight(unit)]);
  return sum;
}

/// d output / d x_i by a central difference.
double input_derivative(const PerceptronShape& shape, const std::vector<double>& parameters, std::vector<double> x,
                        std::size_t i) {
  constexpr double kStep = 1e-5;
  x[i] += kStep;
  const double above = output(shape, parameters, x);
  x[i] -= 2.0 * kStep;
  return (above - output(shape, parameters, x)) / (2.0 * kStep);
}

void expect_what_the_perceptron_gives() {
  for (const PerceptronShape& shape : {PerceptronShape{1, 0, 0}, PerceptronShape{2, 4, 2}, PerceptronShape{3, 7, 2}}) {
    for (std::size_t networks = 1; networks <= 70; ++networks) {
      SCOPED_TRACE(testing::Message() << shape.inputs << "-" << shape.hidden << "-1, seed and networks " << networks);
      Random random(networks);
      const auto parameters = random_values(shape.parameter_count() * networks, 1.5, random);
      const auto inputs = random_values(shape.inputs * networks, 1.0, random);
      std::vector<float> outputs(networks);
      const PerceptronBank bank(shape, networks, parameters);
      ASSERT_EQ(bank.network_count(), networks);
      bank.evaluate(inputs, outputs);
      std::vector<float> same(networks);
      std::vector<float> gradient(inputs.size());
      bank.evaluate(inputs, same, gradient);
      EXPECT_EQ(same, outputs);
      for (std::size_t k = 0; k < networks; ++k) {
        const auto own = lane_of(parameters, networks, k);
        const auto x = lane_of(inputs, networks, k);
        EXPECT_NEAR(outputs[k], output(shape, own, x), 2e-6 * magnitude(shape, own, x)) << "network " << k;
        for (std::size_t i = 0; i < shape.inputs; ++i) {
          EXPECT_NEAR(gradient[i * networks + k], input_derivative(shape, own, x, i), 2e-5) << "network " << k;
        }
      }
    }
  }
}

TEST(PerceptronBank, every_network_gives_what_the_perceptron_gives_on_every_instruction_set) {
  support::for_each_simd_target(expect_what_the_perceptron_gives);
}

TEST(PerceptronBank, writes_its_outputs_and_nothing_beside_them) {
  const PerceptronShape shape{2, 3, 0};
  constexpr float kGuard = 12345.0F;
  for (std::size_t networks = 1; networks <= 70; ++networks) {
    Random random(networks);
    std::vector<float> outputs(networks + 128, kGuard);
    PerceptronBank(shape, networks, random_values(shape.parameter_count() * networks, 1.0, random))
        .evaluate(random_values(2 * networks, 1.0, random), std::span(outputs).subspan(64, networks));
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const bool inside = k >= 64 && k < 64 + networks;
      EXPECT_EQ(outputs[k] == kGuard, !inside) << networks << " networks, place " << k;
    }
  }
}

TEST(PerceptronBank, sigmoid_is_within_a_millionth_over_its_whole_range) {
  // y = f(x) alone: bias 0, weight 1, c 0, v 1, s 0.
  constexpr std::size_t kNetworks = 20'001;
  std::vector<float> parameters;
  for (const float value : {0.0F, 1.0F, 0.0F, 1.0F, 0.0F}) parameters.insert(parameters.end(), kNetworks, value);
  std::vector<float> inputs(kNetworks);
  for (std::size_t k = 0; k < kNetworks; ++k) inputs[k] = static_cast<float>(k) / 100.0F - 100.0F;
  std::vector<float> outputs(kNetworks);
  PerceptronBank({1, 1, 0}, kNetworks, parameters).evaluate(inputs, outputs);
  for (std::size_t k = 0; k < kNetworks; ++k) {
    EXPECT_NEAR(outputs[k], sigmoid(static_cast<double>(inputs[k])), 1e-6) << "at " << inputs[k];
  }
}

TEST(PerceptronBank, extreme_sums_saturate_without_nan) {
  const float largest = std::numeric_limits<float>::max();
  for (const float sum : {1e3F, 1e30F, largest, std::numeric_limits<float>::infinity()}) {
    for (const std::size_t networks : {1U, 3U, 8U, 16U, 33U}) {
      for (const float sign : {-1.0F, 1.0F}) {
        std::vector<float> parameters;
        for (const float value : {sign * sum, 0.0F, 0.25F, 2.0F, 0.0F}) {
          parameters.insert(parameters.end(), networks, value);
        }
        std::vector<float> outputs(networks);
        PerceptronBank({1, 1, 0}, networks, parameters).evaluate(std::vector<float>(networks, 1.0F), outputs);
        for (const float y : outputs) EXPECT_NEAR(y, sign > 0.0F ? 2.25F : 0.25F, 1e-6F) << sign * sum;
      }
    }
  }
}

TEST(PerceptronBank, without_networks_there_is_nothing_to_do) {
  const PerceptronBank bank;
  EXPECT_EQ(bank.network_count(), 0U);
  bank.evaluate({}, {});
}

TEST(PerceptronBank, keeps_its_own_copy_of_the_parameters) {
  std::vector<float> parameters = {1.0F, 2.0F};  // c, s
  const PerceptronBank bank({1, 0, 0}, 1, parameters);
  parameters.assign(2, 0.0F);
  std::vector<float> y(1);
  bank.evaluate(std::vector<float>{3.0F}, y);
  EXPECT_EQ(y[0], 7.0F);
}

}  // namespace
}  // namespace dermis::touch::network
