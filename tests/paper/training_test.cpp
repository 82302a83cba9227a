// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/touch/frames/random.hpp"
#include "paper/reference_network.hpp"
#include "paper/training/levenberg_marquardt.hpp"
#include "support/allocation_guard.hpp"
#include "support/dense_solve.hpp"
#include "support/simd_targets.hpp"

namespace dermis::paper {
namespace {

using Numbers = std::vector<double>;

constexpr TrainingAlgorithm kAlgorithms[] = {
    TrainingAlgorithm::gradient_descent,      TrainingAlgorithm::adaptive_rate,
    TrainingAlgorithm::resilient_propagation, TrainingAlgorithm::conjugate_gradient,
    TrainingAlgorithm::levenberg_marquardt,   TrainingAlgorithm::adam};

template <typename Real>
struct Data {
  std::size_t count = 0;
  std::vector<Real> inputs;
  std::vector<Real> targets;
  std::vector<Real> weights;

  [[nodiscard]] Samples<Real> view() const { return {count, inputs, targets, weights}; }
};

/// y_k = sin(2 x_1 + k) + x_2 ..., the inputs in +-1.
template <typename Real>
Data<Real> waves(std::size_t count, std::size_t inputs, std::size_t outputs, std::uint64_t seed) {
  Random random(seed);
  Data<Real> data;
  data.count = count;
  for (std::size_t p = 0; p < count; ++p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < inputs; ++i) {
      data.inputs.push_back(static_cast<Real>(random.uniform(-1.0, 1.0)));
      sum += (i == 0 ? 2.0 : 0.5) * double{data.inputs.back()};
    }
    for (std::size_t k = 0; k < outputs; ++k) {
      data.targets.push_back(static_cast<Real>(std::sin(sum + static_cast<double>(k))));
    }
  }
  return data;
}

/// Eq. (6) of the patterns `chosen`, weighted, and its gradient.
template <typename Real>
double plain_error(const NetworkShape& shape, const Numbers& parameters, const Data<Real>& data,
                   const std::vector<std::size_t>& chosen, Numbers& gradient) {
  const ReferenceNetwork network(shape, parameters);
  gradient.assign(parameters.size(), 0.0);
  double error = 0.0;
  for (const std::size_t p : chosen) {
    const auto input = data.inputs.begin() + static_cast<std::ptrdiff_t>(p * shape.inputs);
    const auto outputs = network.layer_outputs(Numbers(input, input + static_cast<std::ptrdiff_t>(shape.inputs)));
    const double weight = data.weights.empty() ? 1.0 : double{data.weights[p]};
    for (std::size_t k = 0; k < shape.outputs(); ++k) {
      const double difference = outputs.back()[k] - double{data.targets[p * shape.outputs() + k]};
      const Numbers slopes = network.output_gradient(outputs, k);
      error += 0.5 * weight * difference * difference;
      for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += weight * difference * slopes[i];
    }
  }
  return error;
}

std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

/// Eq. (2) over all patterns without weights, and its gradient.
double plain_mean_square(const NetworkShape& shape, const Numbers& parameters, const Data<double>& data,
                         Numbers& gradient) {
  const double factor = 2.0 / static_cast<double>(data.targets.size());
  const double error = factor * plain_error(shape, parameters, data, all_of(data.count), gradient);
  for (double& value : gradient) value *= factor;
  return error;
}

double norm_square(const Numbers& v) {
  return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
}

double distance(const Numbers& a, const Numbers& b) {
  EXPECT_EQ(a.size(), b.size());
  double greatest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) greatest = std::max(greatest, std::abs(a[i] - b[i]));
  return greatest;
}

template <typename Real>
Numbers as_double(const std::vector<Real>& values) {
  return Numbers(values.begin(), values.end());
}

const NetworkShape kSmall{2, {{4, Activation::log_sigmoid}, {1, Activation::linear}}};
const NetworkShape kDeep{3, {{5, Activation::tanh}, {4, Activation::log_sigmoid}, {2, Activation::linear}}};

template <typename Real>
TrainingState<Real> trained(const NetworkShape& shape, const Data<Real>& data, const TrainingOptions& options,
                            const Data<Real>& validation = {}, const TrainingCallback<Real>& callback = {}) {
  TrainingState<Real> state = start_training(shape, xavier_start<Real>(shape, 3), options);
  const auto report = train(state, data.view(), options, validation.view(), callback);
  EXPECT_TRUE(report) << report.error().message;
  return state;
}

/// Runs train() and compares the parameters after each epoch with those that `step` makes of the last.
void expect_trajectory(const NetworkShape& shape, const Data<double>& data, const TrainingOptions& options,
                       double tolerance, const std::function<void(Numbers& parameters)>& step) {
  Numbers expected = xavier_start<double>(shape, 3);
  std::uint64_t epochs = 0;
  trained<double>(shape, data, options, {}, [&](const TrainingState<double>& state) {
    step(expected);
    EXPECT_LT(distance(state.parameters, expected), tolerance) << "epoch " << state.epoch;
    EXPECT_EQ(state.epoch, ++epochs);
    return !testing::Test::HasFailure();
  });
  EXPECT_EQ(epochs, options.epochs);
}

// ---- The minimum of linear least squares, known in closed form

/// A linear neuron over noisy data, and its least squares solution.
struct LinearProblem {
  NetworkShape shape{3, {{1, Activation::linear}}};
  Data<double> data = waves<double>(40, 3, 1, 5);
  Numbers minimum;
  double least_error = 0.0;

  LinearProblem() {
    Numbers normal(16, 0.0);
    Numbers right(4, 0.0);
    for (std::size_t p = 0; p < data.count; ++p) {
      const double row[] = {data.inputs[3 * p], data.inputs[3 * p + 1], data.inputs[3 * p + 2], 1.0};
      for (std::size_t i = 0; i < 4; ++i) {
        right[i] += row[i] * data.targets[p];
        for (std::size_t j = 0; j < 4; ++j) normal[4 * i + j] += row[i] * row[j];
      }
    }
    minimum = support::solve(normal, right, 4);
    Numbers gradient;
    least_error = plain_mean_square(shape, minimum, data, gradient);
  }
};

TEST(Training, every_algorithm_finds_the_minimum_of_linear_least_squares) {
  const LinearProblem problem;
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    SCOPED_TRACE(name(algorithm));
    const TrainingOptions options{.algorithm = algorithm, .rate = 0.05, .epochs = 3000};
    const auto state = trained(problem.shape, problem.data, options);
    EXPECT_LT(distance(state.best_parameters, problem.minimum), 1e-5);
    EXPECT_NEAR(state.best_error / problem.least_error, 1.0, 1e-9);
  }
}

TEST(Training, batches_find_the_parameters_that_made_the_data) {
  LinearProblem problem;
  const Numbers truth = {0.5, -1.0, 2.0, 0.25};
  for (std::size_t p = 0; p < problem.data.count; ++p) {
    problem.data.targets[p] = truth[3];
    for (std::size_t i = 0; i < 3; ++i) problem.data.targets[p] += truth[i] * problem.data.inputs[3 * p + i];
  }
  for (const TrainingAlgorithm algorithm : {TrainingAlgorithm::gradient_descent, TrainingAlgorithm::adam}) {
    for (const std::size_t batch : {1U, 7U, 39U}) {
      SCOPED_TRACE(testing::Message() << name(algorithm) << ", batch " << batch);
      const TrainingOptions options{
          .algorithm = algorithm, .batch = batch, .rate = 0.005, .epochs = 5000, .error_goal = 1e-12};
      const auto state = trained(problem.shape, problem.data, options);
      EXPECT_LT(distance(state.best_parameters, truth), 1e-5);
    }
  }
}

template <typename Real>
void expect_all_learn_a_wave() {
  const Data<Real> data = waves<Real>(60, 1, 1, 2);
  const NetworkShape shape{1, {{6, Activation::tanh}, {1, Activation::linear}}};
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    for (const std::size_t batch : {0U, 1U, 8U}) {
      const bool takes_batches =
          algorithm == TrainingAlgorithm::gradient_descent || algorithm == TrainingAlgorithm::adam;
      if (batch != 0 && !takes_batches) continue;
      if (algorithm == TrainingAlgorithm::levenberg_marquardt && std::same_as<Real, float>) continue;
      SCOPED_TRACE(testing::Message() << name(algorithm) << ", batch " << batch);
      const TrainingOptions options{
          .algorithm = algorithm, .batch = batch, .rate = 0.02, .epochs = 5000, .error_goal = 1e-3};
      TrainingState<Real> state = start_training(shape, nguyen_widrow_start<Real>(shape, {{{-1.0, 1.0}}}, 1), options);
      const auto report = train(state, data.view(), options);
      ASSERT_TRUE(report);
      EXPECT_EQ(report->stop, StopReason::error_goal) << state.best_error << " after " << state.epoch;
      EXPECT_LE(state.error, 1e-3);
      Numbers gradient;
      const double mean_square =
          2.0 / 60.0 * plain_error(shape, as_double(state.best_parameters), data, all_of(60), gradient);
      EXPECT_NEAR(state.best_error / mean_square, 1.0, 1e-3);
    }
  }
}

TEST(Training, every_algorithm_learns_a_wave_in_single_precision) {
  expect_all_learn_a_wave<float>();
}

TEST(Training, every_algorithm_learns_a_wave_in_double_precision) {
  expect_all_learn_a_wave<double>();
}

// ---- Step by step against independent implementations

TEST(Training, adaptive_rate_takes_the_steps_of_traingdx) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  const TrainingOptions options{.algorithm = TrainingAlgorithm::adaptive_rate, .rate = 0.5, .epochs = 150};
  double rate = options.rate;
  Numbers change;
  Numbers gradient;
  int refused = 0;
  int tolerated = 0;
  int grown = 0;
  expect_trajectory(kSmall, data, options, 1e-8, [&](Numbers& x) {
    const double perf = plain_mean_square(kSmall, x, data, gradient);
    if (change.empty()) {
      for (const double g : gradient) change.push_back(-rate * g);
    }
    Numbers x2 = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      change[i] = 0.9 * change[i] - 0.1 * rate * gradient[i];
      x2[i] += change[i];
    }
    Numbers unused;
    const double perf2 = plain_mean_square(kSmall, x2, data, unused);
    if (perf2 / perf > 1.04) {
      ++refused;
      rate *= 0.7;
      for (std::size_t i = 0; i < x.size(); ++i) change[i] = -rate * gradient[i];
      return;
    }
    ++(perf2 < perf ? grown : tolerated);
    if (perf2 < perf) rate *= 1.05;
    x = x2;
  });
  EXPECT_GT(refused, 0);
  EXPECT_GT(tolerated, 0);
  EXPECT_GT(grown, 50);
}

TEST(Training, adaptive_rate_after_a_refused_step_keeps_the_point_and_goes_along_the_gradient_alone) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  const TrainingOptions options{.algorithm = TrainingAlgorithm::adaptive_rate, .rate = 1000.0, .epochs = 1};
  const Numbers start = xavier_start<double>(kSmall, 3);
  const auto state = trained(kSmall, data, options);
  EXPECT_EQ(state.parameters, start);
  EXPECT_EQ(state.error, state.curve.errors[0]);
  EXPECT_DOUBLE_EQ(state.numbers[0], 700.0);
  Numbers gradient;
  plain_mean_square(kSmall, start, data, gradient);
  for (std::size_t i = 0; i < gradient.size(); ++i) EXPECT_NEAR(state.memory[i], -700.0 * gradient[i], 1e-9);
}

TEST(Training, adaptive_rate_takes_an_error_that_is_not_finite_for_a_rise) {
  Data<float> data = waves<float>(10, 1, 1, 1);
  const NetworkShape shape{1, {{1, Activation::linear}, {1, Activation::linear}}};
  const TrainingOptions options{.algorithm = TrainingAlgorithm::adaptive_rate, .rate = 1e30, .epochs = 400};
  const auto state = trained(shape, data, options);
  EXPECT_TRUE(std::isfinite(state.error));
  EXPECT_LT(state.best_error, state.curve.errors[0]);
  EXPECT_LT(state.numbers[0], 10.0);
}

TEST(Training, resilient_propagation_takes_the_steps_of_irprop_minus) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  const TrainingOptions options{.algorithm = TrainingAlgorithm::resilient_propagation, .epochs = 100};
  Numbers last(kSmall.parameter_count(), 0.0);
  Numbers size(kSmall.parameter_count(), 0.1);
  int sign_changes = 0;
  expect_trajectory(kSmall, data, options, 1e-9, [&](Numbers& w) {
    Numbers g;
    plain_mean_square(kSmall, w, data, g);
    for (std::size_t i = 0; i < w.size(); ++i) {
      if (last[i] * g[i] > 0.0) size[i] = std::fmin(1.2 * size[i], 50.0);
      if (last[i] * g[i] < 0.0) {
        size[i] = std::fmax(0.5 * size[i], 1e-6);
        g[i] = 0.0;
        ++sign_changes;
      }
      w[i] -= size[i] * ((g[i] > 0.0 ? 1.0 : 0.0) - (g[i] < 0.0 ? 1.0 : 0.0));
      last[i] = g[i];
    }
  });
  EXPECT_GT(sign_changes, 100);
}

/// Moller 1993, his nine steps with his own variables, on the error of eq. (6).
struct Moller {
  std::function<double(const Numbers& w, Numbers& r)> error_and_downhill;
  Numbers r = {};
  Numbers p = {};
  double lambda = 1e-6;
  double lambda_bar = 0.0;
  double delta = 0.0;
  bool success = true;
  std::size_t k = 0;
  int refused = 0;
  int indefinite = 0;

  void step(Numbers& w) {
    const std::size_t n = w.size();
    if (p.empty()) {
      error_and_downhill(w, r);
      p = r;
    }
    const double p2 = norm_square(p);
    Numbers moved(n);
    Numbers moved_r;
    if (success) {
      const double sigma = 1e-4 / std::sqrt(p2);
      for (std::size_t i = 0; i < n; ++i) moved[i] = w[i] + sigma * p[i];
      error_and_downhill(moved, moved_r);
      delta = 0.0;
      for (std::size_t i = 0; i < n; ++i) delta += p[i] * (r[i] - moved_r[i]) / sigma;
    }
    delta += (lambda - lambda_bar) * p2;
    if (delta <= 0.0) {
      ++indefinite;
      lambda_bar = 2.0 * (lambda - delta / p2);
      delta = -delta + lambda * p2;
      lambda = lambda_bar;
    }
    const double mu = std::inner_product(p.begin(), p.end(), r.begin(), 0.0);
    for (std::size_t i = 0; i < n; ++i) moved[i] = w[i] + mu / delta * p[i];
    Numbers unused;
    const double drop = error_and_downhill(w, unused) - error_and_downhill(moved, moved_r);
    const double comparison = 2.0 * delta * drop / (mu * mu);
    success = comparison >= 0.0;
    if (success) {
      const double overlap = std::inner_product(moved_r.begin(), moved_r.end(), r.begin(), 0.0);
      const double beta = ++k % n == 0 ? 0.0 : (norm_square(moved_r) - overlap) / mu;
      w = moved;
      r = moved_r;
      for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + beta * p[i];
      lambda_bar = 0.0;
      if (comparison >= 0.75) lambda *= 0.25;
    } else {
      ++refused;
      lambda_bar = lambda;
    }
    if (comparison < 0.25) lambda += delta * (1.0 - comparison) / p2;
  }
};

TEST(Training, conjugate_gradient_takes_the_steps_of_moller) {
  int refused = 0;
  int indefinite = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Data<double> data = waves<double>(50, 2, 1, seed);
    const auto error_and_downhill = [&](const Numbers& w, Numbers& r) {
      const double error = plain_error(kSmall, w, data, all_of(data.count), r);
      for (double& value : r) value = -value;
      return error;
    };
    Moller moller{error_and_downhill};
    const TrainingOptions options{.algorithm = TrainingAlgorithm::conjugate_gradient, .epochs = 30};
    expect_trajectory(kSmall, data, options, 1e-6, [&](Numbers& w) { moller.step(w); });
    refused += moller.refused;
    indefinite += moller.indefinite;
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(indefinite, 0);
}

TEST(Training, conjugate_gradient_minimises_a_quadratic_in_as_many_steps_as_it_has_unknowns) {
  for (const std::size_t inputs : {3U, 7U, 15U}) {
    SCOPED_TRACE(inputs);
    const Data<double> data = waves<double>(100, inputs, 1, inputs);
    const NetworkShape shape{inputs, {{1, Activation::linear}}};
    TrainingOptions options{.algorithm = TrainingAlgorithm::conjugate_gradient, .epochs = 1000};
    const double least = trained(shape, data, options).best_error;
    options.epochs = inputs + 1;
    const auto state = trained(shape, data, options);
    EXPECT_LT(state.error - least, 1e-8 * (state.curve.errors[0] - least));
    options.epochs = (inputs + 1) / 2;
    EXPECT_GT(trained(shape, data, options).error - least, 1e-8 * (state.curve.errors[0] - least));
  }
}

TEST(Training, levenberg_marquardt_is_the_loop_of_its_own_header) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  const TrainingOptions options{.algorithm = TrainingAlgorithm::levenberg_marquardt, .epochs = 30};
  const auto state = trained(kSmall, data, options);
  FeedForward<double> network(kSmall);
  Numbers parameters = xavier_start<double>(kSmall, 3);
  touch::network::LevenbergMarquardtOptions loop;
  loop.max_iterations = 30;
  loop.relative_reduction = 0.0;
  const auto report = minimise(network, PackedSamples<double>(kSmall, data.view()), parameters, loop);
  EXPECT_EQ(state.parameters, parameters);
  EXPECT_EQ(state.best_parameters, parameters);
  EXPECT_DOUBLE_EQ(state.error, report.final_error * 2.0 / 50.0);
  EXPECT_EQ(state.epoch, 30U);
}

/// The order of the header: drawn from the seed and the number of the epoch.
std::vector<std::size_t> order_of_epoch(std::size_t count, std::uint64_t seed, std::uint64_t epoch) {
  Random random = Random::stream(seed, epoch);
  std::vector<std::size_t> order = all_of(count);
  for (std::size_t i = count - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
  return order;
}

/// The batches of an epoch of 23 patterns.
std::vector<std::vector<std::size_t>> batches_of_epoch(std::size_t batch, std::uint64_t seed, std::uint64_t epoch) {
  if (batch == 0) return {all_of(23)};
  const auto order = order_of_epoch(23, seed, epoch);
  std::vector<std::vector<std::size_t>> batches;
  for (std::size_t first = 0; first < order.size(); first += batch) {
    const std::size_t last = std::min(first + batch, order.size());
    batches.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(first),
                         order.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return batches;
}

TEST(Training, gradient_descent_takes_its_steps_batch_by_batch) {
  for (const bool weighted : {false, true}) {
    Data<double> data = waves<double>(23, 3, 2, 4);
    for (std::size_t p = 0; weighted && p < 23; ++p) data.weights.push_back(0.1 * static_cast<double>(p % 5));
    for (const std::size_t batch : {0U, 1U, 5U, 22U}) {
      SCOPED_TRACE(testing::Message() << "batch " << batch << ", weighted " << weighted);
      const TrainingOptions options{.algorithm = TrainingAlgorithm::gradient_descent,
                                    .batch = batch,
                                    .rate = 0.1,
                                    .momentum = 0.8,
                                    .epochs = 5,
                                    .seed = 9};
      Numbers step(kDeep.parameter_count(), 0.0);
      std::uint64_t epoch = 0;
      expect_trajectory(kDeep, data, options, 1e-10, [&](Numbers& w) {
        for (const auto& chosen : batches_of_epoch(batch, 9, epoch)) {
          Numbers gradient;
          plain_error(kDeep, w, data, chosen, gradient);
          for (std::size_t i = 0; i < w.size(); ++i) {
            step[i] = 0.8 * step[i] - 0.1 * gradient[i] / static_cast<double>(chosen.size());
            w[i] += step[i];
          }
        }
        ++epoch;
      });
    }
  }
}

TEST(Training, adam_takes_its_steps_batch_by_batch) {
  const Data<double> data = waves<double>(23, 3, 2, 4);
  for (const std::size_t batch : {0U, 1U, 5U}) {
    SCOPED_TRACE(testing::Message() << "batch " << batch);
    const TrainingOptions options{
        .algorithm = TrainingAlgorithm::adam, .batch = batch, .rate = 0.02, .epochs = 10, .seed = 9};
    Numbers m(kDeep.parameter_count(), 0.0);
    Numbers v(kDeep.parameter_count(), 0.0);
    int t = 0;
    std::uint64_t epoch = 0;
    expect_trajectory(kDeep, data, options, 1e-9, [&](Numbers& w) {
      for (const auto& chosen : batches_of_epoch(batch, 9, epoch)) {
        Numbers gradient;
        plain_error(kDeep, w, data, chosen, gradient);
        ++t;
        for (std::size_t i = 0; i < w.size(); ++i) {
          const double g = gradient[i] / static_cast<double>(chosen.size());
          m[i] = 0.9 * m[i] + 0.1 * g;
          v[i] = 0.999 * v[i] + 0.001 * g * g;
          w[i] -= 0.02 * (m[i] / (1.0 - std::pow(0.9, t))) / (std::sqrt(v[i] / (1.0 - std::pow(0.999, t))) + 1e-8);
        }
      }
      ++epoch;
    });
  }
}

/// One epoch pattern by pattern of a network of random shape: what a kernel with units or inputs in its lanes could get
/// wrong.
template <typename Real>
void expect_pattern_descent_follows_the_plain_network(std::uint64_t seed, double tolerance) {
  Random random(seed);
  NetworkShape shape{1 + random.below(20), {}};
  const std::size_t layers = 1 + random.below(3);
  const std::size_t most_units = seed % 2 == 0 ? 35 : 7;
  for (std::size_t l = 0; l < layers; ++l) {
    shape.layers.push_back({1 + random.below(most_units), static_cast<Activation>(random.below(4))});
  }
  SCOPED_TRACE(testing::Message() << "seed " << seed << ", network " << shape.describe());
  const Data<Real> data = waves<Real>(12, shape.inputs, shape.outputs(), seed);
  const TrainingOptions options{.algorithm = TrainingAlgorithm::gradient_descent,
                                .batch = 1,
                                .rate = 0.01,
                                .momentum = 0.5,
                                .epochs = 1,
                                .seed = seed};
  const auto state = trained(shape, data, options);
  Numbers w = as_double(xavier_start<Real>(shape, 3));
  Numbers step(w.size(), 0.0);
  for (const std::size_t p : order_of_epoch(12, seed, 0)) {
    Numbers gradient;
    plain_error(shape, w, data, {p}, gradient);
    for (std::size_t i = 0; i < w.size(); ++i) {
      step[i] = 0.5 * step[i] - 0.01 * gradient[i];
      w[i] += step[i];
    }
  }
  EXPECT_LT(distance(as_double(state.parameters), w), tolerance);
  EXPECT_LT(distance(as_double(state.memory), step), tolerance);
}

TEST(Training, pattern_by_pattern_follows_the_plain_network_whatever_the_shape) {
  support::for_each_simd_target([] {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      expect_pattern_descent_follows_the_plain_network<float>(seed, 2e-5);
      expect_pattern_descent_follows_the_plain_network<double>(seed, 1e-12);
    }
  });
}

// ---- Determinism and resuming

template <typename Real>
void expect_resumable_at_every_epoch(const TrainingOptions& options, bool validates) {
  const Data<Real> data = waves<Real>(23, 3, 2, 4);
  const Data<Real> validation = validates ? waves<Real>(9, 3, 2, 5) : Data<Real>{};
  const TrainingState<Real> whole = trained(kDeep, data, options, validation);
  ASSERT_EQ(whole.epoch, options.epochs);
  TrainingState<Real> stopped_each_epoch = start_training(kDeep, xavier_start<Real>(kDeep, 3), options);
  for (std::uint64_t epochs = 0; epochs <= options.epochs; ++epochs) {
    TrainingOptions part = options;
    part.epochs = epochs;
    ASSERT_TRUE(train(stopped_each_epoch, data.view(), part, validation.view()));
    TrainingState<Real> resumed = stopped_each_epoch;
    ASSERT_TRUE(train(resumed, data.view(), options, validation.view()));
    EXPECT_EQ(resumed, whole) << "stopped at epoch " << epochs;
  }
}

TEST(Training, stopped_and_resumed_gives_the_same_bits_as_one_run) {
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    for (const std::size_t batch : {0U, 1U, 6U}) {
      const bool takes_batches =
          algorithm == TrainingAlgorithm::gradient_descent || algorithm == TrainingAlgorithm::adam;
      if (batch != 0 && !takes_batches) continue;
      for (const bool validates : {false, true}) {
        SCOPED_TRACE(testing::Message() << name(algorithm) << ", batch " << batch << ", validation " << validates);
        const TrainingOptions options{
            .algorithm = algorithm, .batch = batch, .rate = 0.5, .epochs = 25, .patience = 99};
        expect_resumable_at_every_epoch<double>(options, validates);
        if (algorithm != TrainingAlgorithm::levenberg_marquardt)
          expect_resumable_at_every_epoch<float>(options, validates);
      }
    }
  }
}

TEST(Training, the_callback_sees_states_that_can_be_resumed) {
  const Data<double> data = waves<double>(23, 3, 2, 4);
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    SCOPED_TRACE(name(algorithm));
    const TrainingOptions options{.algorithm = algorithm, .epochs = 12};
    std::vector<TrainingState<double>> seen;
    const auto whole = trained<double>(kDeep, data, options, {}, [&](const TrainingState<double>& state) {
      seen.push_back(state);
      return true;
    });
    ASSERT_EQ(seen.size(), 12U);
    for (TrainingState<double>& state : seen) {
      ASSERT_TRUE(train(state, data.view(), options));
      EXPECT_EQ(state, whole);
    }
  }
}

TEST(Training, trainings_side_by_side_give_the_bits_of_one_after_the_other) {
  const Data<float> data = waves<float>(40, 3, 2, 4);
  for (const std::size_t batch : {0U, 1U, 6U}) {
    const auto train_one = [&](std::uint64_t seed) {
      const TrainingOptions options{
          .algorithm = TrainingAlgorithm::gradient_descent, .batch = batch, .epochs = 30, .seed = seed};
      return trained(kDeep, data, options);
    };
    std::vector<TrainingState<float>> side_by_side(8);
    learn::calibration::parallel_for(8, [&](std::size_t k) { side_by_side[k] = train_one(k); });
    for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(side_by_side[k], train_one(k));
  }
}

TEST(Training, the_order_of_patterns_follows_the_seed) {
  const Data<float> data = waves<float>(40, 2, 1, 4);
  for (const TrainingAlgorithm algorithm : {TrainingAlgorithm::gradient_descent, TrainingAlgorithm::adam}) {
    for (const std::size_t batch : {1U, 8U}) {
      TrainingOptions options{.algorithm = algorithm, .batch = batch, .epochs = 3, .seed = 5};
      const auto state = trained(kSmall, data, options);
      EXPECT_EQ(trained(kSmall, data, options), state);
      options.seed = 6;
      EXPECT_NE(trained(kSmall, data, options).parameters, state.parameters);
    }
  }
}

// ---- What is kept and recorded

TEST(Training, early_stopping_keeps_the_best_validation_point) {
  // 12 noisy patterns and 61 unknowns: the network learns the noise.
  Data<double> data = waves<double>(12, 1, 1, 8);
  Random random(8);
  for (double& target : data.targets) target += 0.3 * random.normal();
  const Data<double> validation = waves<double>(100, 1, 1, 9);
  const NetworkShape shape{1, {{20, Activation::tanh}, {1, Activation::linear}}};
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    SCOPED_TRACE(name(algorithm));
    const TrainingOptions options{.algorithm = algorithm, .rate = 0.05, .epochs = 20'000, .patience = 30};
    TrainingState<double> state = start_training(shape, xavier_start<double>(shape, 3), options);
    const auto report = train(state, data.view(), options, validation.view());
    ASSERT_TRUE(report);
    EXPECT_EQ(report->stop, StopReason::validation);
    EXPECT_EQ(state.epoch, state.best_epoch + 30);
    const Numbers& errors = state.curve.validation_errors;
    ASSERT_EQ(errors.size(), state.epoch + 1);
    EXPECT_EQ(state.best_error, *std::min_element(errors.begin(), errors.end()));
    EXPECT_EQ(state.best_error, errors[state.best_epoch]);
    Numbers gradient;
    EXPECT_NEAR(plain_mean_square(shape, state.best_parameters, validation, gradient), state.best_error, 1e-12);
    EXPECT_NEAR(plain_mean_square(shape, state.parameters, validation, gradient), state.validation_error, 1e-12);
  }
}

TEST(Training, without_validation_samples_the_point_of_the_lowest_error_is_kept) {
  const Data<double> data = waves<double>(30, 2, 1, 8);
  const TrainingOptions options{
      .algorithm = TrainingAlgorithm::gradient_descent, .batch = 1, .rate = 0.3, .epochs = 50};
  const auto state = trained(kSmall, data, options);
  const Numbers& errors = state.curve.errors;
  ASSERT_EQ(errors.size(), 51U);
  EXPECT_EQ(state.error, errors.back());
  EXPECT_EQ(state.best_error, *std::min_element(errors.begin(), errors.end()));
  EXPECT_LT(state.best_epoch, 50U) << "the test needs an error that goes up and down";
  Numbers gradient;
  EXPECT_NEAR(plain_mean_square(kSmall, state.best_parameters, data, gradient), state.best_error, 1e-12);
}

TEST(Training, the_error_is_the_weighted_mean_square_over_all_outputs) {
  Data<double> data = waves<double>(3, 3, 2, 8);
  data.weights = {1.0, 0.0, 3.0};
  const auto state = trained(kDeep, data, {.epochs = 0});
  Numbers gradient;
  EXPECT_NEAR(state.error, 2.0 * plain_error(kDeep, state.parameters, data, all_of(3), gradient) / (2.0 * 4.0), 1e-14);
  data.weights = {0.5, 0.0, 1.5};
  EXPECT_NEAR(trained(kDeep, data, {.epochs = 0}).error, state.error, 1e-14);
}

TEST(Training, the_curve_is_thinned_evenly) {
  const Data<double> data = waves<double>(2, 1, 1, 8);
  const NetworkShape shape{1, {{1, Activation::linear}}};
  const TrainingOptions options{.algorithm = TrainingAlgorithm::gradient_descent,
                                .rate = 1e-4,
                                .momentum = 0.0,
                                .epochs = 70'000,
                                .patience = 70'000};
  Numbers all;
  const auto start = trained(shape, data, {.algorithm = TrainingAlgorithm::gradient_descent, .epochs = 0}, data);
  all.push_back(start.error);
  const auto state = trained<double>(shape, data, options, data, [&](const TrainingState<double>& now) {
    all.push_back(now.error);
    EXPECT_LE(now.curve.errors.size(), ErrorCurve::kMaxValues);
    return true;
  });
  EXPECT_EQ(state.curve.stride, 8U);
  ASSERT_EQ(state.curve.errors.size(), 70'000 / 8 + 1);
  for (std::size_t i = 0; i < state.curve.errors.size(); ++i) EXPECT_EQ(state.curve.errors[i], all[8 * i]) << i;
  EXPECT_EQ(state.curve.validation_errors, state.curve.errors);  // the same samples
}

TEST(Training, allocates_nothing_between_the_first_epoch_and_the_last) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const Data<float> data = waves<float>(50, 3, 2, 7);
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    if (algorithm == TrainingAlgorithm::levenberg_marquardt) continue;
    for (const std::size_t batch : {0U, 1U, 8U}) {
      const bool takes_batches =
          algorithm == TrainingAlgorithm::gradient_descent || algorithm == TrainingAlgorithm::adam;
      if (batch != 0 && !takes_batches) continue;
      SCOPED_TRACE(testing::Message() << name(algorithm) << ", batch " << batch);
      const support::AllocationGuard whole;
      std::optional<support::AllocationGuard> guard;
      std::size_t allocations = 0;
      const TrainingOptions options{.algorithm = algorithm, .batch = batch, .epochs = 40'000, .patience = 40'000};
      trained<float>(kDeep, data, options, data, [&](const TrainingState<float>& state) {
        if (state.epoch == 1) guard.emplace();
        allocations = guard->count();
        return state.epoch < 100;
      });
      EXPECT_EQ(allocations, 0U);
      EXPECT_GT(whole.count(), 0U) << "nothing is counted";
    }
  }
}

// ---- Why it stops, and what it notes

StopReason stop_of(TrainingState<double>& state, const Data<double>& data, const TrainingOptions& options,
                   const TrainingCallback<double>& callback = {}) {
  const auto report = train(state, data.view(), options, {}, callback);
  EXPECT_TRUE(report) << report.error().message;
  return report->stop;
}

TEST(Training, stops_and_says_why) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    SCOPED_TRACE(name(algorithm));
    const auto fresh = [&] {
      return start_training(kSmall, xavier_start<double>(kSmall, 3), {.algorithm = algorithm});
    };
    auto state = fresh();
    EXPECT_EQ(stop_of(state, data, {.algorithm = algorithm, .epochs = 7}), StopReason::epoch_limit);
    EXPECT_EQ(state.epoch, 7U);

    state = fresh();
    const double goal = 0.9 * trained(kSmall, data, {.algorithm = algorithm, .epochs = 0}).error;
    EXPECT_EQ(stop_of(state, data, {.algorithm = algorithm, .error_goal = goal}), StopReason::error_goal);
    EXPECT_LE(state.error, goal);
    ASSERT_GE(state.curve.errors.size(), 2U);
    EXPECT_GT(state.curve.errors[state.epoch - 1], goal);
    EXPECT_EQ(stop_of(state, data, {.algorithm = algorithm, .error_goal = goal}), StopReason::error_goal) << "again";

    state = fresh();
    EXPECT_EQ(stop_of(state, data, {.algorithm = algorithm, .gradient_limit = 0.02}), StopReason::gradient_limit);
    Numbers gradient;
    plain_mean_square(kSmall, state.parameters, data, gradient);
    const auto is_small = [](double g) { return std::abs(g) <= 0.02 + 1e-12; };
    EXPECT_TRUE(std::all_of(gradient.begin(), gradient.end(), is_small));
    EXPECT_LT(state.epoch, 10'000U);

    state = fresh();
    int calls = 0;
    EXPECT_EQ(stop_of(state, data, {.algorithm = algorithm},
                      [&](const TrainingState<double>& now) {
                        EXPECT_EQ(&now, &state);
                        return ++calls < 3;
                      }),
              StopReason::callback);
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(state.epoch, 3U);
  }
}

TEST(Training, at_a_minimum_no_step_goes_down) {
  const LinearProblem problem;
  for (const auto algorithm : {TrainingAlgorithm::conjugate_gradient, TrainingAlgorithm::levenberg_marquardt}) {
    SCOPED_TRACE(name(algorithm));
    const TrainingOptions options{.algorithm = algorithm};
    TrainingState<double> state = start_training(problem.shape, problem.minimum, options);
    EXPECT_EQ(stop_of(state, problem.data, options), StopReason::no_descent);
    EXPECT_LT(state.epoch, 200U);
  }
}

TEST(Training, a_gradient_too_small_to_be_squared_is_the_end_of_conjugate_gradient) {
  Data<double> data = waves<double>(5, 1, 1, 7);
  std::fill(data.inputs.begin(), data.inputs.end(), 1.0);
  std::fill(data.targets.begin(), data.targets.end(), 1.0);
  const NetworkShape shape{1, {{1, Activation::log_sigmoid}}};
  const TrainingOptions options{.algorithm = TrainingAlgorithm::conjugate_gradient, .epochs = 50};
  TrainingState<double> state = start_training(shape, Numbers{-200.0, -200.0}, options);
  EXPECT_EQ(stop_of(state, data, options), StopReason::no_descent);
  EXPECT_TRUE(check_state(state, shape, options.algorithm));
}

TEST(Training, divergence_stops_with_the_best_finite_point) {
  const Data<double> data = waves<double>(50, 2, 1, 7);
  const NetworkShape shape{2, {{4, Activation::relu}, {1, Activation::linear}}};
  for (const std::size_t batch : {0U, 1U, 10U}) {
    SCOPED_TRACE(batch);
    const TrainingOptions options{.algorithm = TrainingAlgorithm::gradient_descent, .batch = batch, .rate = 100.0};
    TrainingState<double> state = start_training(shape, xavier_start<double>(shape, 3), options);
    bool told = false;
    EXPECT_EQ(stop_of(state, data, options,
                      [&](const TrainingState<double>& now) {
                        told = told || !std::isfinite(now.error);
                        return true;
                      }),
              StopReason::diverged);
    EXPECT_FALSE(told);
    EXPECT_TRUE(std::isfinite(state.best_error));
    Numbers gradient;
    EXPECT_NEAR(plain_mean_square(shape, state.best_parameters, data, gradient) / state.best_error, 1.0, 1e-12);
    state.parameters.assign(state.parameters.size(), std::numeric_limits<double>::infinity());
    const auto again = train(state, data.view(), options);
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().message,
              "training state: number 0 of its parameters is not finite; start again from the best parameters");
  }
}

TEST(Training, a_start_whose_error_overflows_is_called_diverged) {
  Data<float> data = waves<float>(5, 2, 1, 7);
  data.targets[2] = 3e38F;
  for (const TrainingAlgorithm algorithm : kAlgorithms) {
    if (algorithm == TrainingAlgorithm::levenberg_marquardt) continue;
    SCOPED_TRACE(name(algorithm));
    const TrainingOptions options{.algorithm = algorithm};
    std::vector<float> start = xavier_start<float>(kSmall, 3);
    start.back() = -3e38F;
    TrainingState<float> state = start_training(kSmall, start, options);
    const auto report = train(state, data.view(), options);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->stop, StopReason::diverged);
    EXPECT_EQ(state.best_parameters, start);
  }
}

TEST(Training, reports_constant_inputs_and_fewer_targets_than_unknowns) {
  Data<double> data = waves<double>(20, 3, 2, 7);  // 40 target values
  for (std::size_t p = 0; p < 20; ++p) data.inputs[3 * p + 1] = 0.7;
  TrainingState<double> state = start_training(kDeep, xavier_start<double>(kDeep, 3), {});
  auto report = train(state, data.view(), {.epochs = 10});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->constant_inputs, std::vector<std::size_t>{1});
  EXPECT_TRUE(report->underdetermined) << kDeep.parameter_count();
  EXPECT_LT(state.error, state.curve.errors[0]);

  const Data<double> enough = waves<double>(27, 3, 2, 7);  // 54 target values, as many as unknowns
  ASSERT_EQ(kDeep.parameter_count(), 54U);
  state = start_training(kDeep, xavier_start<double>(kDeep, 3), {});
  report = train(state, enough.view(), {.epochs = 10});
  EXPECT_TRUE(report->constant_inputs.empty());
  EXPECT_FALSE(report->underdetermined);
}

// ---- What cannot be used

std::string refusal(TrainingState<double> state, const Data<double>& data, const TrainingOptions& options,
                    const Data<double>& validation = {}) {
  const TrainingState<double> before = state;
  const auto report = train(state, data.view(), options, validation.view());
  EXPECT_EQ(state, before);
  if (report) return "accepted";
  EXPECT_EQ(report.error().kind, ErrorKind::bad_input);
  return report.error().message;
}

TEST(Training, refuses_samples_that_cannot_be_trained_on) {
  const TrainingState<double> state = start_training(kSmall, xavier_start<double>(kSmall, 3), {});
  const Data<double> good = waves<double>(5, 2, 1, 1);
  Data<double> bad = good;
  bad.inputs[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(state, bad, {}), "samples: input 1 of pattern 3 is not a finite number");
  EXPECT_EQ(refusal(state, good, {}, bad), "validation samples: input 1 of pattern 3 is not a finite number");
  EXPECT_EQ(refusal(state, {}, {}), "samples: there is no pattern");
  EXPECT_EQ(refusal(state, waves<double>(5, 3, 1, 1), {}),
            "samples: 5 patterns for a network of 2 inputs and 1 outputs come with 15 inputs and 5 targets");
}

TEST(Training, refuses_a_state_of_another_training_and_names_what_differs) {
  const Data<double> data = waves<double>(5, 2, 1, 1);
  const TrainingOptions adam{.algorithm = TrainingAlgorithm::adam, .epochs = 5};
  const TrainingState<double> good = trained(kSmall, data, adam);
  EXPECT_EQ(refusal(good, data, {.algorithm = TrainingAlgorithm::gradient_descent}),
            "training state: is of adam, not gradient_descent");
  EXPECT_EQ(refusal(good, data, adam, data), "training state: began without validation samples and must go on so");
  EXPECT_EQ(refusal(trained(kSmall, data, adam, data), data, adam),
            "training state: began with validation samples and must go on so");

  const auto with = [&](const std::function<void(TrainingState<double>&)>& change) {
    TrainingState<double> state = good;
    change(state);
    return refusal(state, data, adam);
  };
  EXPECT_EQ(with([](auto& s) { s.parameters.pop_back(); }), "training state: has 16 parameters, not 17");
  EXPECT_EQ(with([](auto& s) { s.best_parameters.clear(); }), "training state: has 0 best parameters, not 17");
  EXPECT_EQ(with([](auto& s) { s.memory.resize(17); }), "training state: has 17 memory, not 34");
  EXPECT_EQ(with([](auto& s) { s.numbers.clear(); }), "training state: has 0 numbers, not 1");
  EXPECT_EQ(with([](auto& s) { s.memory[3] = std::numeric_limits<double>::infinity(); }),
            "training state: number 3 of its memory is not finite; start again from the best parameters");
  EXPECT_EQ(with([](auto& s) { s.best_epoch = 6; }), "training state: its best epoch is yet to come");
  EXPECT_EQ(with([](auto& s) { s.curve.errors.pop_back(); }),
            "training state: a curve of 5 errors, one in 1, does not fit its epoch 5");
  EXPECT_EQ(with([](auto& s) { s.curve.stride = 0; }),
            "training state: a curve of 6 errors, one in 0, does not fit its epoch 5");
  EXPECT_EQ(with([](auto& s) { s.curve.validation_errors.resize(2); }),
            "training state: the curves have different lengths");
  EXPECT_EQ(with([](auto& s) { s.shape.layers.clear(); }), "network.layers: must be 1 to 64 layers");

  const Status other = check_state(good, {2, {{7}, {1}}}, TrainingAlgorithm::adam);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message, "training state: is of a network 2-4-1, not 2-7-1");
  EXPECT_TRUE(check_state(good, kSmall, TrainingAlgorithm::adam));
  TrainingState<double> spoilt = good;
  spoilt.best_error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check_state(spoilt, kSmall, TrainingAlgorithm::adam).error().message,
            "training state: its best error is not a number");
}

TEST(Training, refuses_levenberg_marquardt_where_it_cannot_be_done) {
  const TrainingOptions options{.algorithm = TrainingAlgorithm::levenberg_marquardt};
  const Data<float> data = waves<float>(5, 2, 1, 1);
  TrainingState<float> single = start_training(kSmall, xavier_start<float>(kSmall, 3), options);
  const auto report = train(single, data.view(), options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "training: levenberg_marquardt needs double precision");
  const NetworkShape large{2, {{64}, {64}, {1}}};
  EXPECT_EQ(refusal(start_training(large, xavier_start<double>(large, 3), options), waves<double>(5, 2, 1, 1), options),
            "training: levenberg_marquardt takes at most 4096 unknowns, a network 2-64-64-1 has 4417; use "
            "conjugate_gradient");
}

TEST(Training, refuses_options_out_of_range) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto message = [](const std::function<void(TrainingOptions&)>& change) {
    TrainingOptions options;
    change(options);
    const Status valid = options.validate();
    return valid ? "accepted" : valid.error().message;
  };
  EXPECT_EQ(message([](auto&) {}), "accepted");
  for (const double value : {0.0, -1.0, nan, infinity}) {
    EXPECT_EQ(message([&](auto& o) { o.rate = value; }), "training.rate: must be greater than 0");
  }
  for (const double value : {-0.1, 1.0, nan}) {
    EXPECT_EQ(message([&](auto& o) { o.momentum = value; }), "training.momentum: must be at least 0 and less than 1");
  }
  for (const double value : {0.99, nan, infinity}) {
    EXPECT_EQ(message([&](auto& o) { o.rate_increase = value; }), "training.rate_increase: must be at least 1");
    EXPECT_EQ(message([&](auto& o) { o.max_error_increase = value; }),
              "training.max_error_increase: must be at least 1");
  }
  for (const double value : {0.0, 1.0, nan}) {
    EXPECT_EQ(message([&](auto& o) { o.rate_decrease = value; }), "training.rate_decrease: must be between 0 and 1");
  }
  for (const double value : {-1e-9, nan}) {
    EXPECT_EQ(message([&](auto& o) { o.error_goal = value; }), "training.error_goal: must be at least 0");
    EXPECT_EQ(message([&](auto& o) { o.gradient_limit = value; }), "training.gradient_limit: must be at least 0");
  }
  EXPECT_EQ(message([](auto& o) { o.patience = 0; }), "training.patience: must be at least 1");
  EXPECT_EQ(message([](auto& o) { o.algorithm = static_cast<TrainingAlgorithm>(17); }), "training.algorithm: unknown");
  EXPECT_EQ(message([](auto& o) { o.batch = 5; }),
            "training.batch: must be 0, as this algorithm takes all patterns; gradient_descent and adam take batches");
  EXPECT_EQ(message([](auto& o) {
              o.algorithm = TrainingAlgorithm::adam;
              o.batch = 5;
              o.gradient_limit = 1e-3;
            }),
            "training.gradient_limit: must be 0 where there is a batch");
}

}  // namespace
}  // namespace dermis::paper
