// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/feed_forward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "paper/reference_network.hpp"
#include "support/allocation_guard.hpp"
#include "support/gradient_check.hpp"
#include "support/places.hpp"
#include "support/simd_targets.hpp"

namespace dermis::paper {
namespace {

constexpr Activation kActivations[] = {Activation::log_sigmoid, Activation::tanh, Activation::relu, Activation::linear};

/// Rounding that a sum of `Real` may collect, relative to the sum of what is added up.
template <typename Real>
constexpr double kTolerance = std::is_same_v<Real, float> ? 5e-6 : 1e-14;

/// A network and samples whose numbers are the same in float and double.
struct Problem {
  NetworkShape shape;
  std::size_t count = 0;
  std::vector<double> parameters;
  std::vector<double> inputs;
  std::vector<double> targets;
  std::vector<double> weights;
};

double float_value(double value) {
  return static_cast<double>(static_cast<float>(value));
}

std::vector<double> random_values(std::size_t count, double scale, Random& random) {
  std::vector<double> values(count);
  for (double& value : values) value = float_value(scale * random.normal());
  return values;
}

Problem random_problem(const NetworkShape& shape, std::size_t count, Random& random) {
  Problem problem{shape, count, {}, {}, {}, {}};
  problem.parameters = random_values(shape.parameter_count(), 0.8, random);
  problem.inputs = random_values(count * shape.inputs, 1.0, random);
  problem.targets = random_values(count * shape.outputs(), 1.0, random);
  for (std::size_t p = 0; p < count; ++p) {
    problem.weights.push_back(random.below(8) == 0 ? 0.0 : float_value(random.uniform(0.1, 2.0)));
  }
  return problem;
}

/// Any depth up to 4, any mix of activations, widths on both sides of what kernels take at a time.
NetworkShape random_shape(Random& random) {
  NetworkShape shape{1 + random.below(11), {}};
  const std::size_t depth = 1 + random.below(4);
  for (std::size_t layer = 0; layer < depth; ++layer) {
    const std::size_t units = 1 + random.below(layer + 1 == depth ? 4 : 13);
    shape.layers.push_back({units, kActivations[random.below(4)]});
  }
  return shape;
}

template <typename Real>
std::vector<Real> as(const std::vector<double>& values) {
  std::vector<Real> converted;
  for (const double value : values) converted.push_back(static_cast<Real>(value));
  return converted;
}

/// Everything the engine says about a problem.
template <typename Real>
struct Answer {
  std::vector<Real> outputs;
  double error = 0.0;
  double error_with_gradient = 0.0;
  double error_with_normal = 0.0;
  std::vector<Real> gradient;
  std::vector<Real> gradient_with_normal;
  std::vector<Real> normal;
};

template <typename Real>
Answer<Real> ask(const Problem& problem) {
  const std::size_t n = problem.shape.parameter_count();
  const auto parameters = as<Real>(problem.parameters);
  const auto inputs = as<Real>(problem.inputs);
  const auto targets = as<Real>(problem.targets);
  const auto weights = as<Real>(problem.weights);
  const PackedSamples<Real> samples(problem.shape, {problem.count, inputs, targets, weights});
  EXPECT_EQ(samples.count(), problem.count);
  FeedForward<Real> network(problem.shape);
  const Real nan = std::numeric_limits<Real>::quiet_NaN();  // what is not written stays visible
  Answer<Real> answer{
      std::vector<Real>(targets.size(), nan), 0.0, 0.0, 0.0, std::vector<Real>(n, nan), std::vector<Real>(n, nan),
      std::vector<Real>(n * n, nan)};
  network.evaluate(parameters, inputs, answer.outputs);
  answer.error = network.error(parameters, samples);
  answer.error_with_gradient = network.error_and_gradient(parameters, samples, answer.gradient);
  answer.error_with_normal = network.normal_equations(parameters, samples, answer.gradient_with_normal, answer.normal);
  return answer;
}

/// The same from the reference, with the sums of what is added up, which rounding is measured by.
struct Expected {
  std::vector<double> outputs;
  double error = 0.0;
  std::vector<double> gradient;
  std::vector<double> gradient_size;
  std::vector<double> normal;
  std::vector<double> normal_size;
  double largest = 1.0;  // neuron output, target or parameter
};

Expected expect(const Problem& problem) {
  const std::size_t n = problem.shape.parameter_count();
  const std::size_t outputs = problem.shape.outputs();
  const ReferenceNetwork reference(problem.shape, problem.parameters);
  Expected expected{
      {}, 0.0, std::vector<double>(n), std::vector<double>(n), std::vector<double>(n * n), std::vector<double>(n * n)};
  for (std::size_t p = 0; p < problem.count; ++p) {
    const auto input = problem.inputs.begin() + static_cast<std::ptrdiff_t>(p * problem.shape.inputs);
    const auto layers = reference.layer_outputs({input, input + static_cast<std::ptrdiff_t>(problem.shape.inputs)});
    for (const auto& layer : layers) {
      for (const double y : layer) expected.largest = std::max(expected.largest, std::abs(y));
    }
    for (std::size_t k = 0; k < outputs; ++k) {
      const double target = problem.targets[p * outputs + k];
      const double difference = layers.back()[k] - target;
      const double weight = problem.weights.empty() ? 1.0 : problem.weights[p];
      const auto row = reference.output_gradient(layers, k);
      expected.outputs.push_back(layers.back()[k]);
      expected.error += 0.5 * weight * difference * difference;
      for (std::size_t i = 0; i < n; ++i) {
        expected.gradient[i] += weight * difference * row[i];
        expected.gradient_size[i] += weight * (std::abs(difference) + 1.0) * (std::abs(row[i]) + 1.0);
        for (std::size_t j = 0; j < n; ++j) {
          expected.normal[i * n + j] += weight * row[i] * row[j];
          expected.normal_size[i * n + j] += weight * (std::abs(row[i]) + 1.0) * (std::abs(row[j]) + 1.0);
        }
      }
    }
  }
  return expected;
}

template <typename Real>
void expect_agreement(const Problem& problem) {
  const Expected expected = expect(problem);
  const Answer<Real> answer = ask<Real>(problem);
  const double tolerance = kTolerance<Real> * expected.largest;
  const std::size_t n = problem.shape.parameter_count();
  for (std::size_t k = 0; k < expected.outputs.size(); ++k) {
    ASSERT_NEAR(answer.outputs[k], expected.outputs[k], tolerance) << "output " << k;
  }
  const double error_tolerance = tolerance * (expected.error + static_cast<double>(problem.count));
  ASSERT_NEAR(answer.error, expected.error, error_tolerance);
  ASSERT_NEAR(answer.error_with_gradient, expected.error, error_tolerance);
  ASSERT_NEAR(answer.error_with_normal, expected.error, error_tolerance);
  for (std::size_t i = 0; i < n; ++i) {
    const double bound = tolerance * expected.gradient_size[i];
    ASSERT_NEAR(answer.gradient[i], expected.gradient[i], bound) << "parameter " << i;
    ASSERT_NEAR(answer.gradient_with_normal[i], expected.gradient[i], bound) << "parameter " << i;
  }
  for (std::size_t k = 0; k < n * n; ++k) {
    ASSERT_NEAR(answer.normal[k], expected.normal[k], tolerance * expected.normal_size[k]) << "entry " << k;
    ASSERT_EQ(answer.normal[k], answer.normal[k % n * n + k / n]) << "not symmetric at entry " << k;
  }
}

std::string describe(const Problem& problem) {
  std::string text = problem.shape.describe();
  for (const Layer& layer : problem.shape.layers) text += " " + std::string(name(layer.activation));
  return text + ", " + std::to_string(problem.count) + " patterns";
}

TEST(FeedForward, agrees_with_the_reference_on_every_instruction_set) {
  support::for_each_simd_target([] {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      Random random(seed);
      const NetworkShape shape = random_shape(random);
      const Problem problem = random_problem(shape, 1 + random.below(seed % 10 == 0 ? 400 : 60), random);
      SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << describe(problem));
      expect_agreement<double>(problem);
      expect_agreement<float>(problem);
      if (testing::Test::HasFatalFailure()) return;
    }
  });
}

TEST(FeedForward, every_width_of_a_layer_and_every_activation_agrees_with_the_reference) {
  for (std::size_t width = 1; width <= 10; ++width) {
    for (const Activation activation : kActivations) {
      for (const std::size_t inputs : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{4}, width + 4}) {
        Random random(width * 100 + inputs);
        const NetworkShape shape{inputs, {{width, activation}, {1, Activation::linear}}};
        const Problem problem = random_problem(shape, 37, random);
        SCOPED_TRACE(describe(problem));
        expect_agreement<double>(problem);
        expect_agreement<float>(problem);
        if (HasFatalFailure()) return;
      }
    }
  }
}

/// 1, 2, 3, ... patterns: the samples that fill up the last tile must not count, whatever is in them.
TEST(FeedForward, no_number_of_patterns_lets_the_padding_count) {
  support::for_each_simd_target([] {
    for (std::size_t count = 1; count <= 140; count += count < 70 ? 1 : 7) {
      Random random(count);
      Problem problem = random_problem({3, {{5, Activation::tanh}, {2, Activation::log_sigmoid}}}, count, random);
      if (count % 2 == 0) problem.weights.clear();
      SCOPED_TRACE(describe(problem));
      expect_agreement<double>(problem);
      expect_agreement<float>(problem);
      if (testing::Test::HasFatalFailure()) return;
    }
  });
}

TEST(FeedForward, gradients_of_every_layer_agree_with_finite_differences) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    NetworkShape shape = random_shape(random);
    for (Layer& layer : shape.layers) {
      if (layer.activation == Activation::relu) layer.activation = Activation::tanh;  // differences cross the kink
    }
    const Problem problem = random_problem(shape, 20, random);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << describe(problem));
    const PackedSamples<double> samples(shape, {problem.count, problem.inputs, problem.targets, problem.weights});
    FeedForward<double> network(shape);
    const auto error = [&](std::span<const double> p, std::span<double> r, std::span<double> jacobian) {
      r[0] = jacobian.empty() ? network.error(p, samples) : network.error_and_gradient(p, samples, jacobian);
    };
    EXPECT_LT(support::jacobian_deviation(error, 1, problem.parameters), 1e-7);
  }
}

/// The patterns first ... first + count - 1 of a problem.
Problem part_of(const Problem& problem, std::size_t first, std::size_t count) {
  const auto part = [&](const std::vector<double>& values, std::size_t columns) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first * columns);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count * columns));
  };
  return {problem.shape,
          count,
          problem.parameters,
          part(problem.inputs, problem.shape.inputs),
          part(problem.targets, problem.shape.outputs()),
          part(problem.weights, 1)};
}

template <typename Real>
void expect_sum(const std::vector<Real>& whole, const std::vector<Real>& a, const std::vector<Real>& b, Real scale) {
  Real largest = 1;
  for (const Real value : whole) largest = std::max(largest, std::abs(value));
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(whole[k], a[k] + b[k], scale * largest) << "entry " << k;
  }
}

TEST(FeedForward, error_gradient_and_normal_equations_add_up_over_parts_of_the_samples) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const std::size_t count = 2 + random.below(300);
    const std::size_t cut = 1 + random.below(count - 1);
    const Problem problem = random_problem(random_shape(random), count, random);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << describe(problem) << ", cut at " << cut);
    const auto whole = ask<double>(problem);
    const auto first = ask<double>(part_of(problem, 0, cut));
    const auto rest = ask<double>(part_of(problem, cut, count - cut));
    EXPECT_NEAR(whole.error, first.error + rest.error, 1e-12 * (1.0 + whole.error));
    expect_sum(whole.gradient, first.gradient, rest.gradient, 1e-12);
    expect_sum(whole.normal, first.normal, rest.normal, 1e-12);
  }
}

TEST(FeedForward, weight_2_is_the_pattern_twice) {
  Random random(5);
  Problem once = random_problem({4, {{6, Activation::log_sigmoid}, {2, Activation::tanh}}}, 45, random);
  once.weights.assign(45, 1.0);
  Problem doubled = once;
  doubled.weights.assign(45, 2.0);
  const auto a = ask<double>(once);
  const auto b = ask<double>(doubled);
  EXPECT_NEAR(b.error, a.error + a.error, 1e-12 * b.error);
  expect_sum(b.gradient, a.gradient, a.gradient, 1e-13);
  expect_sum(b.normal, a.normal, a.normal, 1e-13);
}

TEST(FeedForward, no_weights_are_weights_of_1) {
  Random random(6);
  Problem problem = random_problem({4, {{6, Activation::log_sigmoid}, {2, Activation::tanh}}}, 45, random);
  problem.weights.assign(45, 1.0);
  const auto with = ask<float>(problem);
  problem.weights.clear();
  const auto without = ask<float>(problem);
  EXPECT_EQ(with.error_with_gradient, without.error_with_gradient);
  EXPECT_EQ(with.gradient, without.gradient);
  EXPECT_EQ(with.normal, without.normal);
}

TEST(FeedForward, a_mini_batch_is_what_its_patterns_are) {
  Random random(7);
  const Problem problem = random_problem({3, {{4, Activation::tanh}, {2, Activation::linear}}}, 200, random);
  const Samples<double> samples{200, problem.inputs, problem.targets, problem.weights};
  FeedForward<double> network(problem.shape);
  const std::size_t n = problem.shape.parameter_count();
  PackedSamples<double> batch;
  for (const std::size_t size : {150U, 1U, 31U, 130U}) {  // the buffers are used again, larger and smaller
    std::vector<std::size_t> chosen(size);
    for (std::size_t& index : chosen) index = random.below(200);
    batch.pack(problem.shape, samples, chosen);
    EXPECT_EQ(batch.count(), size);
    std::vector<double> gradient(n);
    const double error = network.error_and_gradient(problem.parameters, batch, gradient);
    double expected_error = 0.0;
    std::vector<double> expected(n, 0.0);
    for (const std::size_t index : chosen) {
      const auto alone = ask<double>(part_of(problem, index, 1));
      expected_error += alone.error;
      for (std::size_t k = 0; k < n; ++k) expected[k] += alone.gradient[k];
    }
    EXPECT_NEAR(error, expected_error, 1e-11 * expected_error);
    for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(gradient[k], expected[k], 1e-11 * expected_error);
  }
}

template <typename Real>
void expect_finite_extremes() {
  for (const Activation hidden : {Activation::log_sigmoid, Activation::tanh, Activation::relu}) {
    const NetworkShape shape{2, {{3, hidden}, {3, Activation::tanh}, {2, Activation::log_sigmoid}}};
    for (const double scale : {1.0, 1e3, 1e8}) {
      Random random(8);
      Problem problem = random_problem(shape, 60, random);
      for (double& value : problem.inputs) value = random.below(2) == 0 ? 1e4 : -1e4;
      for (double& value : problem.parameters) value = float_value(scale * value);
      SCOPED_TRACE(testing::Message() << name(hidden) << ", weights about " << scale);
      const Answer<Real> answer = ask<Real>(problem);
      EXPECT_TRUE(std::isfinite(answer.error_with_gradient));
      for (const Real value : answer.outputs) EXPECT_TRUE(value >= Real{0} && value <= Real{1}) << value;
      for (const Real value : answer.gradient) EXPECT_TRUE(std::isfinite(value));
      for (const Real value : answer.normal) EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST(FeedForward, extreme_inputs_saturate_and_stay_finite_on_every_instruction_set) {
  support::for_each_simd_target([] {
    expect_finite_extremes<float>();
    expect_finite_extremes<double>();
  });
}

template <typename Real>
void expect_no_silent_nan() {
  for (const Activation activation : kActivations) {
    const NetworkShape shape{2, {{3, activation}, {1, activation}}};
    Random random(9);
    const Problem problem = random_problem(shape, 20, random);
    for (std::size_t k = 0; k < shape.parameter_count(); ++k) {
      Problem poisoned = problem;
      poisoned.parameters[k] = std::numeric_limits<double>::quiet_NaN();
      const Answer<Real> answer = ask<Real>(poisoned);
      EXPECT_TRUE(std::isnan(answer.error)) << name(activation) << ", parameter " << k;
      EXPECT_TRUE(std::isnan(answer.outputs[0])) << name(activation) << ", parameter " << k;
    }
  }
}

TEST(FeedForward, a_parameter_that_is_not_a_number_shows_in_the_error_on_every_instruction_set) {
  support::for_each_simd_target([] {
    expect_no_silent_nan<float>();
    expect_no_silent_nan<double>();
  });
}

TEST(FeedForward, a_nan_of_any_bits_stays_one_on_every_instruction_set) {
  support::for_each_simd_target([] {
    for (const std::uint32_t payload : {0U, 1U, 0x7A2U, 0x3FFFFFU}) {
      const auto single = std::bit_cast<float>(0x7FC00000U | payload);
      const auto whole = std::bit_cast<double>(0x7FF8000000000000U | payload);
      for (const Activation activation : kActivations) {
        SCOPED_TRACE(testing::Message() << name(activation) << ", payload " << payload);
        std::vector<float> y(1);
        FeedForward<float>({1, {{1, activation}}}).evaluate(std::vector<float>{1.0F, 0.0F}, std::vector{single}, y);
        EXPECT_TRUE(std::isnan(y[0])) << y[0];
        std::vector<double> z(1);
        FeedForward<double>({1, {{1, activation}}}).evaluate(std::vector<double>{1.0, 0.0}, std::vector{whole}, z);
        EXPECT_TRUE(std::isnan(z[0])) << z[0];
      }
    }
  });
}

/// One neuron as a function of its input.
template <typename Real>
double largest_deviation(Activation activation, double from, double to) {
  constexpr std::size_t kPoints = 20'001;
  FeedForward<Real> neuron({1, {{1, activation}}});
  std::vector<Real> x(kPoints);
  std::vector<Real> y(kPoints);
  for (std::size_t k = 0; k < kPoints; ++k) {
    x[k] = static_cast<Real>(from + (to - from) * static_cast<double>(k) / (kPoints - 1));
  }
  neuron.evaluate(std::vector<Real>{1, 0}, x, y);
  double deviation = 0.0;
  for (std::size_t k = 0; k < kPoints; ++k) {
    deviation = std::max(deviation, std::abs(double{y[k]} - activate(activation, double{x[k]})));
  }
  return deviation;
}

TEST(FeedForward, a_neuron_is_eq_4_to_the_last_digits_on_every_instruction_set) {
  support::for_each_simd_target([] {
    for (const double range : {1.0, 20.0, 200.0, 2000.0}) {
      SCOPED_TRACE(range);
      EXPECT_LT(largest_deviation<float>(Activation::log_sigmoid, -range, range), 1.3e-7);
      EXPECT_LT(largest_deviation<float>(Activation::tanh, -range, range), 1.8e-7);
      EXPECT_LT(largest_deviation<double>(Activation::log_sigmoid, -range, range), 3e-16);
      EXPECT_LT(largest_deviation<double>(Activation::tanh, -range, range), 4e-16);
    }
  });
}

TEST(FeedForward, closed_forms_of_one_neuron) {
  // w = 2, theta = -1, x = 1.5: the sum is 2, the output 1 / (1 + exp(-2)).
  FeedForward<double> neuron({1, {{1, Activation::log_sigmoid}}});
  const std::vector<double> parameters = {2.0, -1.0};
  const std::vector<double> input = {1.5};
  const std::vector<double> target = {0.25};
  const double o = 1.0 / (1.0 + std::exp(-2.0));
  std::vector<double> output(1);
  neuron.evaluate(parameters, input, output);
  EXPECT_NEAR(output[0], o, 1e-15);

  const PackedSamples<double> samples(neuron.shape(), {1, input, target, {}});
  std::vector<double> gradient(2);
  EXPECT_NEAR(neuron.error_and_gradient(parameters, samples, gradient), 0.5 * (0.25 - o) * (0.25 - o), 1e-15);
  EXPECT_NEAR(gradient[0], (o - 0.25) * o * (1.0 - o) * 1.5, 1e-15);
  EXPECT_NEAR(gradient[1], (o - 0.25) * o * (1.0 - o), 1e-15);
}

TEST(FeedForward, the_error_is_eq_6_of_the_outputs) {
  Random random(10);
  Problem problem = random_problem({3, {{4, Activation::tanh}, {3, Activation::log_sigmoid}}}, 90, random);
  problem.weights.clear();
  const auto answer = ask<double>(problem);
  double expected = 0.0;
  for (std::size_t k = 0; k < problem.targets.size(); ++k) {
    expected += 0.5 * std::pow(problem.targets[k] - answer.outputs[k], 2);
  }
  EXPECT_NEAR(answer.error, expected, 1e-12 * expected);
}

TEST(FeedForward, evaluate_writes_its_outputs_and_nothing_beside_them) {
  support::for_each_simd_target([] {
    for (const std::size_t outputs : {1U, 2U, 3U, 4U, 7U, 8U}) {
      for (const std::size_t count : {1U, 3U, 16U, 17U, 129U}) {
        const NetworkShape shape{outputs + 1, {{outputs, Activation::linear}}};
        Random random(outputs * count);
        const Problem problem = random_problem(shape, count, random);
        constexpr float kGuard = 12345.0F;
        std::vector<float> y(count * outputs + 128, kGuard);
        FeedForward<float>(shape).evaluate(as<float>(problem.parameters), as<float>(problem.inputs),
                                           std::span(y).subspan(64, count * outputs));
        for (std::size_t k = 0; k < y.size(); ++k) {
          const bool inside = k >= 64 && k < 64 + count * outputs;
          EXPECT_EQ(y[k] == kGuard, !inside) << outputs << " outputs, " << count << " patterns, place " << k;
        }
      }
    }
  });
}

TEST(FeedForward, evaluates_nothing_from_nothing) {
  FeedForward<float> network({2, {{3, Activation::tanh}, {1, Activation::linear}}});
  const std::vector<float> parameters(network.shape().parameter_count(), 1.0F);
  network.evaluate(parameters, {}, {});
  EXPECT_EQ(network.error(parameters, PackedSamples<float>(network.shape(), {})), 0.0);
}

TEST(FeedForward, allocates_nothing_once_the_work_space_has_grown) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(11);
  const Problem problem = random_problem({4, {{6, Activation::tanh}, {2, Activation::linear}}}, 300, random);
  const Samples<double> samples{300, problem.inputs, problem.targets, problem.weights};
  const std::size_t n = problem.shape.parameter_count();
  FeedForward<double> network(problem.shape);
  PackedSamples<double> packed(problem.shape, samples);
  std::vector<double> outputs(600);
  std::vector<double> gradient(n);
  std::vector<double> normal(n * n);
  std::vector<std::size_t> chosen(250, 3);
  const auto all = [&] {
    packed.pack(problem.shape, samples, chosen);
    network.evaluate(problem.parameters, problem.inputs, outputs);
    return network.error(problem.parameters, packed) +
           network.error_and_gradient(problem.parameters, packed, gradient) +
           network.normal_equations(problem.parameters, packed, gradient, normal);
  };
  const double first = all();
  const support::AllocationGuard guard;
  const double second = all();
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(first, second);
}

struct GoldenNetwork {
  Problem problem;
  std::vector<double> outputs;
  double error = 0.0;
  std::vector<double> gradient;
};

Activation activation_of(const std::string& text) {
  return *std::find_if(std::begin(kActivations), std::end(kActivations),
                       [&](Activation activation) { return name(activation) == text; });
}

std::vector<GoldenNetwork> read_golden_networks() {
  std::vector<GoldenNetwork> networks;
  std::ifstream file(support::project_folder() / "tests/paper/golden/feed_forward.csv");
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string kind;
    std::getline(cells, kind, ',');
    std::vector<std::string> words;
    for (std::string cell; std::getline(cells, cell, ',');) words.push_back(cell);
    if (kind == "shape") {
      GoldenNetwork& added = networks.emplace_back();
      added.problem.shape.inputs = std::stoul(words[0]);
      for (std::size_t k = 1; k < words.size(); k += 2) {
        added.problem.shape.layers.push_back({std::stoul(words[k]), activation_of(words[k + 1])});
      }
      continue;
    }
    if (kind.front() == '#') continue;
    std::vector<double> values;
    for (const std::string& word : words) values.push_back(std::stod(word));
    GoldenNetwork& golden = networks.back();
    if (kind == "parameters") golden.problem.parameters = values;
    if (kind == "inputs") golden.problem.inputs = values;
    if (kind == "targets") golden.problem.targets = values;
    if (kind == "weights") golden.problem.weights = values;
    if (kind == "outputs") golden.outputs = values;
    if (kind == "error") golden.error = values.at(0);
    if (kind == "gradient") golden.gradient = values;
    golden.problem.count = golden.problem.weights.size();
  }
  return networks;
}

/// What may differ from numpy: absolute in the outputs, relative in the error, and in the gradient relative to its
/// largest entry.
template <typename Real>
struct GoldenTolerance;
template <>
struct GoldenTolerance<float> {
  static constexpr double kOutput = 5e-6;
  static constexpr double kError = 1e-6;
  static constexpr double kGradient = 2e-6;
};
template <>
struct GoldenTolerance<double> {
  static constexpr double kOutput = 2e-14;
  static constexpr double kError = 1e-14;
  static constexpr double kGradient = 1e-14;
};

template <typename Real>
void expect_what_numpy_computes(const GoldenNetwork& golden) {
  using Tolerance = GoldenTolerance<Real>;
  const Answer<Real> answer = ask<Real>(golden.problem);
  ASSERT_EQ(answer.outputs.size(), golden.outputs.size());
  for (std::size_t k = 0; k < golden.outputs.size(); ++k) {
    EXPECT_NEAR(answer.outputs[k], golden.outputs[k], Tolerance::kOutput) << "output " << k;
  }
  for (const double error : {answer.error, answer.error_with_gradient, answer.error_with_normal}) {
    EXPECT_NEAR(error / golden.error, 1.0, Tolerance::kError);
  }
  double largest = 0.0;
  for (const double value : golden.gradient) largest = std::max(largest, std::abs(value));
  ASSERT_EQ(answer.gradient.size(), golden.gradient.size());
  for (std::size_t k = 0; k < golden.gradient.size(); ++k) {
    EXPECT_NEAR(answer.gradient[k], golden.gradient[k], Tolerance::kGradient * largest) << "parameter " << k;
    EXPECT_NEAR(answer.gradient_with_normal[k], golden.gradient[k], Tolerance::kGradient * largest);
  }
}

TEST(FeedForward, computes_what_numpy_computes) {
  const auto networks = read_golden_networks();
  ASSERT_EQ(networks.size(), 6U) << "tests/paper/golden/feed_forward.csv";
  for (const GoldenNetwork& golden : networks) {
    SCOPED_TRACE(describe(golden.problem));
    expect_what_numpy_computes<float>(golden);
    expect_what_numpy_computes<double>(golden);
  }
}

}  // namespace
}  // namespace dermis::paper
