// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "problems.hpp"

#include <algorithm>
#include <cmath>

#include "adaptive_rate.hpp"
#include "dermis/paper/peaks.hpp"
#include "dermis/touch/frames/random.hpp"
#include "engine.hpp"
#include "reference.hpp"

namespace dermis::benchmarks {
namespace {

using paper::NetworkShape;
using reference::as_double;
using reference::max_deviation;
using touch::network::Activation;

std::vector<float> uniform(Random& random, std::size_t count, double low, double high) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.uniform(low, high));
  return values;
}

std::vector<float> as_float(std::span<const double> values) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(value));
  return result;
}

double largest(std::span<const double> values) {
  double greatest = 0.0;
  for (const double value : values) greatest = std::fmax(greatest, std::fabs(value));
  return greatest;
}

std::vector<double> difference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> result(a.begin(), a.end());
  for (std::size_t k = 0; k < b.size(); ++k) result[k] -= b[k];
  return result;
}

/// All networks of a small bank, sixteen of a large one.
std::vector<std::size_t> checked_networks(const BankProblem& problem) {
  std::vector<std::size_t> networks;
  const std::size_t stride = std::max<std::size_t>(1, problem.networks / 16);
  for (std::size_t network = 0; network < problem.networks; network += stride) networks.push_back(network);
  return networks;
}

/// The rows of the database that a network draws.
std::vector<double> chosen_rows(const BankProblem& problem, std::size_t network, std::span<const float> table,
                                std::size_t width, std::size_t first_column, std::size_t columns) {
  std::vector<double> rows;
  for (std::size_t k = 0; k < problem.batch; ++k) {
    const auto row = table.subspan(problem.chosen[network * problem.batch + k] * width + first_column, columns);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

/// Descends 1/batch times eq. (6). Adam from zero moments: the first step is rate * g / (|g| + epsilon).
std::vector<double> step_of(Rule rule, std::span<const double> gradient) {
  std::vector<double> step;
  for (const double slope : gradient) {
    step.push_back(rule == Rule::gradient_descent ? -double{kDescentRate} * slope
                                                  : -double{kAdamRate} * slope / (std::fabs(slope) + 1e-8));
  }
  return step;
}

}  // namespace

PeaksProblem peaks_problem(std::size_t hidden, std::size_t epochs) {
  const paper::PeaksSamples samples = paper::peaks_samples();
  PeaksProblem problem{{2, {{hidden, Activation::log_sigmoid}, {1, Activation::linear}}},
                       as_float(samples.inputs),
                       as_float(samples.targets),
                       {},
                       epochs};
  Random random(1);
  problem.parameters = uniform(random, problem.shape.parameter_count(), -1.0, 1.0);
  return problem;
}

Check check_epochs(const PeaksProblem& problem, std::span<const float> parameters) {
  const std::vector<double> inputs = as_double(problem.inputs);
  const std::vector<double> targets = as_double(problem.targets);
  const auto mean_square_error = [&](const std::vector<double>& at, std::vector<double>& gradient) {
    reference::ErrorAndGradient sum = reference::error_and_gradient(problem.shape, at, inputs, targets);
    const double scale = 2.0 / static_cast<double>(problem.count());
    std::transform(sum.gradient.begin(), sum.gradient.end(), gradient.begin(), [&](double g) { return scale * g; });
    return scale * sum.error;
  };
  AdaptiveRateDescent<double> descent(problem.parameters, mean_square_error);
  for (std::size_t epoch = 0; epoch < kCheckedEpochs; ++epoch) descent.epoch(mean_square_error);
  const double moved = largest(difference(descent.parameters(), as_double(problem.parameters)));
  return {"parameters after 3 epochs, share of the way",
          max_deviation(as_double(parameters), descent.parameters()) / moved, 1e-5};
}

Check check_step(const PeaksProblem& problem, const LevenbergMarquardtStep& step) {
  const std::vector<double> inputs = as_double(problem.inputs);
  const std::vector<double> targets = as_double(problem.targets);
  std::vector<double> parameters = as_double(problem.parameters);
  const std::size_t n = parameters.size();
  const std::vector<double> jacobian = reference::jacobian(problem.shape, parameters, inputs);
  std::vector<double> normal(n * n);
  for (std::size_t p = 0; p < problem.count(); ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) normal[i * n + j] += jacobian[p * n + i] * jacobian[p * n + j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) normal[i * n + i] *= 1.0 + kDamping;
  std::vector<double> expected_step =
      reference::error_and_gradient(problem.shape, parameters, inputs, targets).gradient;
  for (double& slope : expected_step) slope = -slope;
  reference::solve(normal, expected_step);
  for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] += expected_step[k];
  const double trial_error = reference::error_and_gradient(problem.shape, parameters, inputs, targets).error;
  const double step_deviation = max_deviation(step.step, expected_step) / largest(expected_step);
  return {"step and error after it, relative",
          std::fmax(step_deviation, std::fabs(step.trial_error - trial_error) / trial_error), 1e-8};
}

TaxelProblem taxel_problem(std::size_t taxels) {
  const NetworkShape shape{8, {{16, Activation::tanh}, {16, Activation::tanh}, {1, Activation::linear}}};
  Random random(2);
  return {shape, uniform(random, taxels * 8, -1.0, 1.0), uniform(random, shape.parameter_count(), -0.7, 0.7)};
}

Check check_outputs(const TaxelProblem& problem, std::span<const float> outputs) {
  const std::vector<double> expected =
      reference::outputs(problem.shape, as_double(problem.parameters), as_double(problem.inputs));
  return {"outputs", max_deviation(as_double(outputs), expected), 4e-6};
}

double BankProblem::operations(std::size_t count) const {
  const std::size_t weights = shape.parameter_count() - 2 * size() - 1;
  return 2.0 * static_cast<double>(weights * networks * count);
}

BankProblem bank_problem(std::size_t size, std::size_t networks) {
  constexpr std::size_t kPatterns = 512;
  constexpr std::size_t kBatch = 64;
  const NetworkShape shape{
      size, {{size, Activation::log_sigmoid}, {size, Activation::log_sigmoid}, {1, Activation::log_sigmoid}}};
  Random random(3);
  const double spread = 2.0 / std::sqrt(static_cast<double>(size));
  BankProblem problem{shape,
                      networks,
                      uniform(random, networks * shape.parameter_count(), -spread, spread),
                      kBatch,
                      uniform(random, kBatch * size, 0.0, 1.0),
                      uniform(random, kPatterns * size, 0.0, 1.0),
                      uniform(random, kPatterns * networks, 0.25, 0.75),
                      std::vector<std::uint32_t>(networks * kBatch)};
  for (std::uint32_t& row : problem.chosen) row = static_cast<std::uint32_t>(random.below(kPatterns));
  return problem;
}

Check check_outputs(const BankProblem& problem, std::size_t count, std::span<const float> outputs) {
  const std::vector<double> inputs = as_double(std::span(problem.frames).first(count * problem.size()));
  double deviation = 0.0;
  for (const std::size_t network : checked_networks(problem)) {
    const std::vector<double> expected =
        reference::outputs(problem.shape, as_double(problem.parameters(network)), inputs);
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) values.push_back(outputs[k * problem.networks + network]);
    deviation = std::fmax(deviation, max_deviation(values, expected));
  }
  return {"outputs (0 ... 1)", deviation, 2e-6};
}

Check check_training_step(const BankProblem& problem, Rule rule,
                          const std::function<std::vector<float>(std::size_t network)>& parameters) {
  double deviation = 0.0;
  for (const std::size_t network : checked_networks(problem)) {
    const std::vector<double> start = as_double(problem.parameters(network));
    std::vector<double> gradient =
        reference::error_and_gradient(
            problem.shape, start, chosen_rows(problem, network, problem.database, problem.size(), 0, problem.size()),
            chosen_rows(problem, network, problem.targets, problem.networks, network, 1))
            .gradient;
    for (double& slope : gradient) slope /= static_cast<double>(problem.batch);
    const std::vector<double> expected = step_of(rule, gradient);
    const std::vector<double> step = difference(as_double(parameters(network)), start);
    const double steepest = largest(gradient);
    const double longest = largest(expected);
    for (std::size_t k = 0; k < step.size(); ++k) {
      // Adam's first step is the sign of the slope: of slopes that are mere rounding it tells nothing.
      if (rule == Rule::adam && std::fabs(gradient[k]) < 1e-3 * steepest) continue;
      deviation = std::fmax(deviation, max_deviation({&step[k], 1}, {&expected[k], 1}) / longest);
    }
  }
  return {"first step, share of the largest", deviation, 1e-3};
}

}  // namespace dermis::benchmarks
