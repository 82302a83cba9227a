// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/network_bank.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/one_core.hpp"
#include "support/simd_targets.hpp"

namespace dermis::paper {
namespace {

constexpr Activation kLogSigmoid = Activation::log_sigmoid;
constexpr Activation kTanh = Activation::tanh;
constexpr Activation kRelu = Activation::relu;
constexpr Activation kLinear = Activation::linear;

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
    const std::size_t fan_in = shape.fan_in(layer);
    const double scale = 1.0 / std::sqrt(static_cast<double>(fan_in));
    const auto own = random_values(shape.layers[layer].units * (fan_in + 1), scale, random);
    parameters.insert(parameters.end(), own.begin(), own.end());
  }
  return parameters;
}

/// Networks, a database and what each network draws from it, all random.
struct Problem {
  Problem(const NetworkShape& problem_shape, std::size_t networks, std::size_t batch, Random& random)
      : shape(problem_shape),
        patterns(batch + 10),
        inputs(random_values(patterns * shape.inputs, 1.0, random)),
        targets(random_values(patterns * networks * shape.outputs(), 0.5, random)) {
    for (std::size_t network = 0; network < networks; ++network) {
      parameters.push_back(random_parameters(shape, random));
    }
    for (std::size_t k = 0; k < networks * batch; ++k) {
      chosen.push_back(static_cast<std::uint32_t>(random.below(patterns)));
      weights.push_back(static_cast<float>(random.uniform(0.0, 2.0)));
    }
  }

  [[nodiscard]] std::size_t networks() const { return parameters.size(); }
  [[nodiscard]] BankBatch batch() const { return {chosen.size() / networks(), inputs, targets, chosen, weights}; }
  [[nodiscard]] NetworkBank bank() const {
    NetworkBank made(shape, networks());
    for (std::size_t network = 0; network < networks(); ++network) made.set_parameters(network, parameters[network]);
    return made;
  }

  NetworkShape shape;
  std::size_t patterns;
  std::vector<float> inputs;
  std::vector<float> targets;
  std::vector<std::uint32_t> chosen;
  std::vector<float> weights;
  std::vector<std::vector<float>> parameters;
};

std::vector<float> parameters_of(const NetworkBank& bank, std::size_t network) {
  std::vector<float> values(bank.shape().parameter_count());
  bank.parameters(network, values);
  return values;
}

/// What a network of the bank must put out for a pattern: double precision, alone.
std::vector<double> expected_outputs(const Problem& problem, std::size_t network, std::span<const float> inputs) {
  std::vector<double> outputs(inputs.size() / problem.shape.inputs * problem.shape.outputs());
  FeedForward<double>(problem.shape).evaluate(widened(problem.parameters[network]), widened(inputs), outputs);
  return outputs;
}

/// One network's parameters and moments, trained alone in double precision.
struct Alone {
  std::vector<double> parameters;
  std::vector<double> first = std::vector<double>(parameters.size());
  std::vector<double> second = std::vector<double>(parameters.size());
  double steps = 0.0;
};

/// The mean gradient of the patterns that a network draws, and their mean error.
double mean_gradient(const NetworkShape& shape, const BankBatch& batch, std::size_t network, std::size_t networks,
                     std::span<const double> parameters, std::span<double> gradient) {
  std::vector<double> inputs;
  std::vector<double> targets;
  std::vector<double> weights;
  for (std::size_t p = 0; p < batch.batch; ++p) {
    const std::size_t row = batch.chosen[network * batch.batch + p];
    for (std::size_t k = 0; k < shape.inputs; ++k) inputs.push_back(double{batch.inputs[row * shape.inputs + k]});
    for (std::size_t k = 0; k < shape.outputs(); ++k) {
      targets.push_back(double{batch.targets[(row * networks + network) * shape.outputs() + k]});
    }
    weights.push_back(batch.weights.empty() ? 1.0 : double{batch.weights[network * batch.batch + p]});
  }
  const PackedSamples<double> samples(shape, {batch.batch, inputs, targets, weights});
  const double error = FeedForward<double>(shape).error_and_gradient(parameters, samples, gradient);
  for (double& slope : gradient) slope /= static_cast<double>(batch.batch);
  return error / static_cast<double>(batch.batch);
}

/// Gradient descent, or algorithm 1 of Kingma and Ba (2015) to the letter.
void move_alone(Alone& network, std::span<const double> gradient, const BankStep& step) {
  ++network.steps;
  const auto beta1 = double{step.first_decay};
  const auto beta2 = double{step.second_decay};
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    double direction = gradient[i];
    if (step.rule == BankStep::Rule::adam) {
      network.first[i] = beta1 * network.first[i] + (1.0 - beta1) * gradient[i];
      network.second[i] = beta2 * network.second[i] + (1.0 - beta2) * gradient[i] * gradient[i];
      const double first = network.first[i] / (1.0 - std::pow(beta1, network.steps));
      const double second = network.second[i] / (1.0 - std::pow(beta2, network.steps));
      direction = first / (std::sqrt(second) + double{step.epsilon});
    }
    network.parameters[i] -= double{step.rate} * direction;
  }
}

/// Shapes of every kind: wide and small, deep and flat, one output and several, whole vectors and odd ends. Few small
/// networks, and all large ones, lie in panels, many small ones side by side in lanes (network_bank.cpp).
std::vector<NetworkShape> shapes() {
  return {
      {1, {{1, kLinear}}},
      {3, {{1, kLogSigmoid}}},
      {1, {{3, kTanh}, {1, kLinear}}},
      {2, {{17, kLogSigmoid}, {2, kTanh}}},
      {17, {{33, kRelu}, {17, kTanh}, {3, kLogSigmoid}}},
      {33, {{1, kTanh}, {33, kLogSigmoid}, {1, kLinear}}},
      {5, {{12, kTanh}, {9, kLinear}, {6, kRelu}, {1, kTanh}, {5, kLogSigmoid}}},
      {5, {{48, kTanh}, {40, kLinear}, {8, kRelu}, {1, kTanh}, {5, kLogSigmoid}}},
      {257, {{33, kLogSigmoid}, {257, kLogSigmoid}, {1, kLogSigmoid}}},
      {33, {{257, kTanh}, {65, kRelu}, {17, kLinear}}},
  };
}

/// Calls check(problem) for every shape and some numbers of networks.
template <class Check>
void for_every_problem(std::size_t batch, const Check& check) {
  std::uint64_t seed = 0;
  for (const NetworkShape& shape : shapes()) {
    for (const std::size_t networks : {1U, 2U, 7U, 31U}) {
      if (networks * shape.parameter_count() > 150'000) continue;
      Random random(++seed);
      SCOPED_TRACE(testing::Message() << shape.describe() << ", " << networks << " networks, batch of " << batch
                                      << ", seed " << seed);
      check(Problem(shape, networks, batch, random));
    }
  }
}

TEST(NetworkBank, the_bank_of_the_paper_has_33751296_unknowns) {
  const NetworkBank bank({256, {{256, kLogSigmoid}, {256, kLogSigmoid}, {1, kLogSigmoid}}}, 256);
  EXPECT_EQ(bank.parameter_count(), 33'751'296U);
  EXPECT_EQ(bank.network_count(), 256U);
}

TEST(NetworkBank, starts_with_parameters_of_zero) {
  NetworkBank bank({3, {{20, kLogSigmoid}, {2, kLogSigmoid}}}, 3);
  EXPECT_EQ(parameters_of(bank, 2), std::vector<float>(bank.shape().parameter_count()));
  std::vector<float> outputs(6);
  bank.evaluate(std::vector<float>{1.0F, 2.0F, 3.0F}, outputs);
  for (const float output : outputs) EXPECT_NEAR(output, 0.5F, 1e-6F);
}

TEST(NetworkBank, returns_the_parameters_it_was_given) {
  for_every_problem(1, [](const Problem& problem) {
    const NetworkBank bank = problem.bank();
    for (std::size_t network = 0; network < problem.networks(); ++network) {
      EXPECT_EQ(parameters_of(bank, network), problem.parameters[network]);
    }
  });
}

TEST(NetworkBank, every_network_gives_what_it_gives_alone) {
  for (const std::size_t count : {1U, 5U, 64U, 65U}) {
    for_every_problem(count, [&](const Problem& problem) {
      const std::size_t outputs = problem.shape.outputs();
      const std::size_t each = problem.networks() * outputs;
      const auto inputs = std::span(problem.inputs).first(count * problem.shape.inputs);
      std::vector<float> expected(count * each);
      for (std::size_t network = 0; network < problem.networks(); ++network) {
        const auto own = expected_outputs(problem, network, inputs);
        for (std::size_t i = 0; i < own.size(); ++i) {
          expected[i / outputs * each + network * outputs + i % outputs] = static_cast<float>(own[i]);
        }
      }
      support::for_each_simd_target([&] {
        NetworkBank bank = problem.bank();
        constexpr float kGuard = 12345.0F;
        std::vector<float> batch(count * each + 1, kGuard);
        std::vector<float> frame(each + 1, kGuard);
        bank.evaluate_batch(inputs, std::span(batch).first(count * each));
        for (std::size_t p = 0; p < count; ++p) {
          bank.evaluate(inputs.subspan(p * problem.shape.inputs, problem.shape.inputs), std::span(frame).first(each));
          for (std::size_t k = 0; k < each; ++k) {
            ASSERT_NEAR(frame[k], expected[p * each + k], 5e-6) << "pattern " << p << ", output " << k;
            ASSERT_NEAR(batch[p * each + k], expected[p * each + k], 5e-6) << "pattern " << p << ", output " << k;
          }
        }
        EXPECT_EQ(batch.back(), kGuard);
        EXPECT_EQ(frame.back(), kGuard);
      });
    });
  }
}

TEST(NetworkBank, evaluates_more_patterns_than_it_packs_at_a_time) {
  constexpr std::size_t kPatterns = 2500;
  const NetworkShape shape{2, {{40, kTanh}, {1, kLinear}}};
  for (const std::size_t networks : {2U, 16U}) {
    Random random(networks);
    const Problem problem(shape, networks, 1, random);
    NetworkBank bank = problem.bank();
    const auto inputs = random_values(kPatterns * 2, 1.0, random);
    std::vector<float> outputs(kPatterns * networks);
    bank.evaluate_batch(inputs, outputs);
    for (std::size_t network = 0; network < networks; ++network) {
      const auto expected = expected_outputs(problem, network, inputs);
      for (std::size_t p = 0; p < kPatterns; ++p) ASSERT_NEAR(outputs[p * networks + network], expected[p], 5e-6);
    }
  }
}

TEST(NetworkBank, a_batch_of_no_patterns_is_nothing_to_do) {
  NetworkBank bank({2, {{1, kLinear}}}, 3);
  bank.evaluate_batch({}, {});
}

/// Some steps of the bank against the same steps of every network alone.
void expect_steps(const Problem& problem, const BankStep& step, int steps, double tolerance) {
  const std::size_t networks = problem.networks();
  std::vector<Alone> alone;
  for (const auto& parameters : problem.parameters) alone.push_back({widened(parameters)});
  std::vector<std::vector<double>> expected_errors;
  std::vector<double> gradient(problem.shape.parameter_count());
  for (int t = 0; t < steps; ++t) {
    expected_errors.emplace_back();
    for (std::size_t network = 0; network < networks; ++network) {
      expected_errors.back().push_back(
          mean_gradient(problem.shape, problem.batch(), network, networks, alone[network].parameters, gradient));
      move_alone(alone[network], gradient, step);
    }
  }
  support::for_each_simd_target([&] {
    NetworkBank bank = problem.bank();
    std::vector<float> errors(networks);
    for (const auto& expected : expected_errors) {
      bank.train_step(problem.batch(), step, errors);
      for (std::size_t network = 0; network < networks; ++network) {
        EXPECT_NEAR(errors[network], expected[network], tolerance * (1.0 + expected[network]));
      }
    }
    for (std::size_t network = 0; network < networks; ++network) {
      const auto own = parameters_of(bank, network);
      for (std::size_t i = 0; i < own.size(); ++i) {
        ASSERT_NEAR(own[i], alone[network].parameters[i], tolerance) << "network " << network << ", parameter " << i;
      }
    }
  });
}

TEST(NetworkBank, a_step_of_gradient_descent_is_that_of_each_network_alone) {
  for (const std::size_t batch : {1U, 5U, 64U, 65U}) {
    for_every_problem(batch, [&](const Problem& problem) { expect_steps(problem, {.rate = 0.5F}, 1, 1e-5); });
  }
}

TEST(NetworkBank, adam_follows_the_algorithm_of_the_paper) {
  // Epsilon is larger than usual, so that the division does not turn the rounding of a gradient near 0 into its sign.
  const BankStep step{.rule = BankStep::Rule::adam, .rate = 0.01F, .epsilon = 1e-2F};
  for_every_problem(5, [&](const Problem& problem) { expect_steps(problem, step, 5, 2e-5); });
}

TEST(NetworkBank, adam_moves_by_its_rate_at_first) {
  // m / sqrt(v) is the sign of the gradient at the first step, whatever its size.
  for (const std::size_t networks : {1U, 16U}) {
    NetworkBank bank({1, {{1, kLinear}}}, networks);
    const std::vector<float> inputs = {1.0F, 1e-3F};
    const std::vector<float> targets(2 * networks, 1.0F);
    std::vector<std::uint32_t> chosen(networks);
    std::iota(chosen.begin(), chosen.end(), 0U);
    for (std::uint32_t& row : chosen) row %= 2;
    std::vector<float> errors(networks);
    bank.train_step({1, inputs, targets, chosen, {}}, {.rule = BankStep::Rule::adam, .rate = 0.25F}, errors);
    for (std::size_t network = 0; network < networks; ++network) {
      EXPECT_EQ(errors[network], 0.5F);
      for (const float parameter : parameters_of(bank, network)) EXPECT_NEAR(parameter, 0.25F, 1e-5F);
    }
  }
}

TEST(NetworkBank, new_parameters_start_adam_anew_for_their_network_alone) {
  const BankStep step{.rule = BankStep::Rule::adam, .rate = 0.01F};
  for (const NetworkShape& shape : shapes()) {
    SCOPED_TRACE(shape.describe());
    Random random(3);
    const Problem problem(shape, 18, 5, random);
    NetworkBank fresh = problem.bank();
    NetworkBank reset = problem.bank();
    NetworkBank undisturbed = problem.bank();
    std::vector<float> errors(18);
    for (int t = 0; t < 3; ++t) {
      reset.train_step(problem.batch(), step, errors);
      undisturbed.train_step(problem.batch(), step, errors);
    }
    reset.set_parameters(1, problem.parameters[1]);
    for (NetworkBank* bank : {&fresh, &reset, &undisturbed}) bank->train_step(problem.batch(), step, errors);
    EXPECT_EQ(parameters_of(reset, 1), parameters_of(fresh, 1));
    EXPECT_EQ(parameters_of(reset, 0), parameters_of(undisturbed, 0));
    EXPECT_NE(parameters_of(reset, 1), parameters_of(undisturbed, 1));
  }
}

TEST(NetworkBank, goes_on_from_parameters_moments_and_steps_as_if_nothing_had_been) {
  const BankStep step{.rule = BankStep::Rule::adam, .rate = 0.01F};
  for_every_problem(5, [&](const Problem& problem) {
    NetworkBank first = problem.bank();
    NetworkBank second = problem.bank();
    std::vector<float> errors(problem.networks());
    for (int t = 0; t < 3; ++t) first.train_step(problem.batch(), step, errors);
    std::vector<float> values(problem.shape.parameter_count());
    for (std::size_t network = 0; network < problem.networks(); ++network) {
      second.set_parameters(network, parameters_of(first, network));
      for (const AdamMoment which : {AdamMoment::first, AdamMoment::second}) {
        first.moment(which, network, values);
        second.set_moment(which, network, values);
      }
    }
    second.set_adam_steps(3);
    for (NetworkBank* bank : {&first, &second}) bank->train_step(problem.batch(), step, errors);
    for (std::size_t network = 0; network < problem.networks(); ++network) {
      EXPECT_EQ(parameters_of(first, network), parameters_of(second, network));
    }
  });
}

TEST(NetworkBank, a_part_has_the_bits_of_its_networks_in_the_whole) {
  for (const BankStep::Rule rule : {BankStep::Rule::gradient_descent, BankStep::Rule::adam}) {
    for_every_problem(5, [&](const Problem& problem) {
      const std::size_t networks = problem.networks();
      const std::size_t outputs = problem.shape.outputs();
      NetworkBank whole = problem.bank();
      std::vector<float> errors(networks);
      whole.train_step(problem.batch(), {.rule = rule, .rate = 0.1F}, errors);
      std::vector<float> of_whole(networks * outputs);
      const auto inputs = std::span(problem.inputs).first(problem.shape.inputs);
      whole.evaluate(inputs, of_whole);
      for (std::size_t network = 0; network < networks; ++network) {
        NetworkBank part(problem.shape, 1, networks);
        part.set_parameters(0, problem.parameters[network]);
        std::vector<float> targets;
        for (std::size_t p = 0; p < problem.patterns; ++p) {
          const auto own = problem.targets.begin() + static_cast<std::ptrdiff_t>((p * networks + network) * outputs);
          targets.insert(targets.end(), own, own + static_cast<std::ptrdiff_t>(outputs));
        }
        const std::size_t batch = problem.batch().batch;
        const BankBatch own{batch, problem.inputs, targets, std::span(problem.chosen).subspan(network * batch, batch),
                            std::span(problem.weights).subspan(network * batch, batch)};
        float error = 0.0F;
        part.train_step(own, {.rule = rule, .rate = 0.1F}, std::span(&error, 1));
        EXPECT_EQ(error, errors[network]);
        EXPECT_EQ(parameters_of(part, 0), parameters_of(whole, network));
        std::vector<float> of_part(outputs);
        part.evaluate(inputs, of_part);
        EXPECT_TRUE(std::equal(of_part.begin(), of_part.end(), &of_whole[network * outputs]));
      }
    });
  }
}

TEST(NetworkBank, without_weights_all_patterns_count_one) {
  Random random(4);
  constexpr std::size_t kBatch = 20;
  Problem problem({5, {{40, kTanh}, {2, kLinear}}}, 3, kBatch, random);
  NetworkBank none = problem.bank();
  NetworkBank ones = problem.bank();
  std::vector<float> errors_none(3);
  std::vector<float> errors_ones(3);
  problem.weights.assign(3 * kBatch, 1.0F);
  ones.train_step(problem.batch(), {}, errors_ones);
  BankBatch batch = problem.batch();
  batch.weights = {};
  none.train_step(batch, {}, errors_none);
  EXPECT_EQ(errors_none, errors_ones);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(parameters_of(none, k), parameters_of(ones, k));
}

TEST(NetworkBank, a_pattern_of_weight_zero_does_not_count) {
  Random random(6);
  for (const NetworkShape& shape : shapes()) {
    SCOPED_TRACE(shape.describe());
    Problem problem(shape, 17, 6, random);
    NetworkBank six = problem.bank();
    NetworkBank other = problem.bank();
    std::vector<float> errors_six(17);
    std::vector<float> errors_other(17);
    for (std::size_t network = 0; network < 17; ++network) problem.weights[network * 6 + 5] = 0.0F;
    six.train_step(problem.batch(), {}, errors_six);
    for (std::size_t network = 0; network < 17; ++network) problem.chosen[network * 6 + 5] = 0;
    other.train_step(problem.batch(), {}, errors_other);
    EXPECT_EQ(errors_six, errors_other);
    for (std::size_t k = 0; k < 17; ++k) EXPECT_EQ(parameters_of(six, k), parameters_of(other, k));
  }
}

TEST(NetworkBank, results_do_not_depend_on_the_number_of_threads) {
  // Large enough to be shared among threads.
  for (const NetworkShape& shape : {NetworkShape{64, {{64, kLogSigmoid}, {64, kTanh}, {1, kLogSigmoid}}},
                                    NetworkShape{8, {{16, kLogSigmoid}, {16, kTanh}, {1, kLogSigmoid}}}}) {
    Random random(7);
    const std::size_t networks = 2'200'000 / shape.parameter_count();
    const Problem problem(shape, networks, 64, random);
    const auto results = [&] {
      NetworkBank bank = problem.bank();
      std::vector<float> all(networks);
      bank.train_step(problem.batch(), {.rule = BankStep::Rule::adam}, all);
      std::vector<float> outputs(networks * 65);
      bank.evaluate(std::span(problem.inputs).first(shape.inputs), std::span(outputs).first(networks));
      bank.evaluate_batch(std::span(problem.inputs).first(64 * shape.inputs), std::span(outputs).subspan(networks));
      all.insert(all.end(), outputs.begin(), outputs.end());
      for (std::size_t k = 0; k < networks; ++k) {
        const auto own = parameters_of(bank, k);
        all.insert(all.end(), own.begin(), own.end());
      }
      return all;
    };
    const std::vector<float> on_all_cores = results();
    support::on_one_core([&] { EXPECT_EQ(results(), on_all_cores); });
  }
}

TEST(NetworkBank, allocates_nothing_once_the_work_space_has_grown) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const std::size_t networks : {1U, 16U}) {  // in panels and in lanes, on one thread
    Random random(networks);
    const Problem problem({3, {{20, kTanh}, {1, kLinear}}}, networks, 6, random);
    NetworkBank bank = problem.bank();
    std::vector<float> outputs(5 * networks);
    std::vector<float> errors(networks);
    const auto use = [&] {
      bank.evaluate(std::span(problem.inputs).first(3), std::span(outputs).first(networks));
      bank.evaluate_batch(std::span(problem.inputs).first(15), outputs);
      bank.train_step(problem.batch(), {.rule = BankStep::Rule::adam}, errors);
    };
    use();
    const support::AllocationGuard guard;
    use();
    EXPECT_EQ(guard.count(), 0U) << networks << " networks";
  }
}

TEST(NetworkBank, a_diverged_network_says_so_and_its_neighbours_do_not_notice) {
  for (const NetworkShape& shape : shapes()) {
    SCOPED_TRACE(shape.describe());
    Random random(8);
    const Problem problem(shape, 19, 5, random);
    support::for_each_simd_target([&] {
      NetworkBank healthy = problem.bank();
      NetworkBank bank = problem.bank();
      auto diverged = problem.parameters[3];
      std::fill(diverged.begin(), diverged.end(), std::numeric_limits<float>::quiet_NaN());
      bank.set_parameters(3, diverged);
      std::vector<float> errors(19);
      std::vector<float> expected(19);
      const BankStep step{.rule = BankStep::Rule::adam, .rate = 0.01F};
      for (int t = 0; t < 2; ++t) {
        healthy.train_step(problem.batch(), step, expected);
        bank.train_step(problem.batch(), step, errors);
      }
      std::vector<float> outputs(19 * shape.outputs());
      bank.evaluate(std::span(problem.inputs).first(shape.inputs), outputs);
      for (std::size_t network = 0; network < 19; ++network) {
        SCOPED_TRACE(network);
        EXPECT_EQ(std::isfinite(errors[network]), network != 3);
        EXPECT_EQ(std::isfinite(outputs[network * shape.outputs()]), network != 3);
        if (network == 3) continue;
        EXPECT_EQ(errors[network], expected[network]);
        EXPECT_EQ(parameters_of(bank, network), parameters_of(healthy, network));
      }
      // New parameters mend it.
      bank.set_parameters(3, problem.parameters[3]);
      healthy.set_parameters(3, problem.parameters[3]);
      healthy.train_step(problem.batch(), step, expected);
      bank.train_step(problem.batch(), step, errors);
      EXPECT_EQ(errors, expected);
      EXPECT_EQ(parameters_of(bank, 3), parameters_of(healthy, 3));
    });
  }
}

TEST(NetworkBank, extreme_sums_saturate) {
  support::for_each_simd_target([] {
    for (const float sum : {1e3F, 1e30F, std::numeric_limits<float>::max()}) {
      for (const std::size_t networks : {1U, 20U}) {
        for (const std::size_t units : {3U, 100U}) {
          NetworkBank bank({1, {{units, kLogSigmoid}, {units, kTanh}}}, networks);
          std::vector<float> parameters(units * 2 + units * (units + 1));
          // Up, then down; the second layer looks at the first two units, and the last unit at none.
          parameters[0] = sum;
          parameters[1] = -sum;
          parameters[units * 2] = 100.0F;
          parameters[units * 3 + 1] = 100.0F;
          for (std::size_t k = 0; k < networks; ++k) bank.set_parameters(k, parameters);
          std::vector<float> outputs(networks * units);
          bank.evaluate(std::vector<float>{1.0F}, outputs);
          for (std::size_t k = 0; k < networks; ++k) {
            EXPECT_NEAR(outputs[k * units], 1.0F, 1e-6F);
            EXPECT_NEAR(outputs[k * units + 1], 0.0F, 1e-6F);
            EXPECT_NEAR(outputs[k * units + units - 1], 0.0F, 1e-6F);
          }
        }
      }
    }
  });
}

}  // namespace
}  // namespace dermis::paper
