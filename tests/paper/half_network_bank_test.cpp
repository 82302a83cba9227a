// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/half_network_bank.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dermis/core/random.hpp"
#include "support/simd_targets.hpp"

namespace dermis::paper {
namespace {

/// Networks with sums of the order of 1 and the outputs of one random frame.
struct Example {
  Example(const NetworkShape& shape, std::size_t networks, Random& random)
      : bank(shape, networks), inputs(shape.inputs), outputs(networks * shape.outputs()) {
    std::vector<float> parameters(shape.parameter_count());
    for (std::size_t network = 0; network < networks; ++network) {
      for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
        const double scale = 1.0 / std::sqrt(static_cast<double>(shape.fan_in(layer)));
        for (std::size_t i = shape.weights(layer); i < shape.weights(layer + 1); ++i) {
          parameters[i] = static_cast<float>(scale * random.normal());
        }
      }
      bank.set_parameters(network, parameters);
    }
    for (float& input : inputs) input = static_cast<float>(random.uniform());
    bank.evaluate(inputs, outputs);
  }

  NetworkBank bank;
  std::vector<float> inputs;
  std::vector<float> outputs;
};

TEST(HalfNetworkBank, outputs_are_within_a_thousandth_of_full_scale) {
  constexpr Activation kLogSigmoid = Activation::log_sigmoid;
  const NetworkShape shapes[] = {
      {256, {{256, kLogSigmoid}, {256, kLogSigmoid}, {1, kLogSigmoid}}},
      {257, {{33, kLogSigmoid}, {17, Activation::tanh}, {3, kLogSigmoid}}},
      {3, {{5, Activation::relu}, {1, kLogSigmoid}}},
  };
  for (const NetworkShape& shape : shapes) {
    for (std::size_t networks = 1; networks <= 7; networks += 3) {
      SCOPED_TRACE(testing::Message() << shape.describe() << ", networks and seed " << networks);
      Random random(networks);
      const Example example(shape, networks, random);
      support::for_each_simd_target([&] {
        auto half = HalfNetworkBank::from(example.bank);
        ASSERT_TRUE(half) << half.error().message;
        ASSERT_EQ(half->network_count(), networks);
        ASSERT_EQ(half->shape(), shape);
        std::vector<float> outputs(example.outputs.size());
        for (int frame = 0; frame < 2; ++frame) {
          half->evaluate(example.inputs, outputs);
          for (std::size_t k = 0; k < outputs.size(); ++k) EXPECT_NEAR(outputs[k], example.outputs[k], 1e-3F);
        }
      });
    }
  }
}

TEST(HalfNetworkBank, parameters_that_16_bits_hold_give_the_outputs_of_single_precision) {
  const NetworkShape shape{2, {{1, Activation::linear}}};
  NetworkBank bank(shape, 1);
  bank.set_parameters(0, std::vector<float>{65'504.0F, -0.25F, 512.5F});
  auto half = HalfNetworkBank::from(bank);
  ASSERT_TRUE(half);
  std::vector<float> output(1);
  half->evaluate(std::vector<float>{1.0F, 2.0F}, output);
  EXPECT_EQ(output[0], 65'504.0F - 0.5F + 512.5F);
}

TEST(HalfNetworkBank, a_parameter_that_does_not_fit_is_named) {
  for (const float value :
       {65'505.0F, -1e10F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    NetworkBank bank({2, {{1, Activation::linear}}}, 3);
    bank.set_parameters(2, std::vector<float>{0.0F, value, 0.0F});
    const auto half = HalfNetworkBank::from(bank);
    ASSERT_FALSE(half);
    EXPECT_NE(half.error().message.find("network 2, parameter 1"), std::string::npos) << half.error().message;
  }
}

TEST(HalfNetworkBank, results_do_not_depend_on_the_number_of_threads) {
  Random random(9);
  // Large enough to be shared among threads.
  const Example example({64, {{64, Activation::log_sigmoid}, {1, Activation::log_sigmoid}}}, 520, random);
  auto half = HalfNetworkBank::from(example.bank);
  ASSERT_TRUE(half);
  std::vector<float> one(520);
  std::vector<float> four(520);
  half->evaluate(example.inputs, four);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  half->evaluate(example.inputs, one);
  EXPECT_EQ(one, four);
}

}  // namespace
}  // namespace dermis::paper
