// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dermis/paper/network_shape.hpp"

/// The works: the same data and the same start for every engine, and what it must compute.
namespace dermis::benchmarks {

struct Check;
enum class Rule;

/// The Peaks function, eq. (1) of the paper, on its 61 x 61 points, and the paper's network 2-H-1 (Fig. 5): sigmoid
/// units, linear output.
struct PeaksProblem {
  paper::NetworkShape shape;
  std::vector<float> inputs;      ///< [3721, 2]: x, y
  std::vector<float> targets;     ///< [3721]: z
  std::vector<float> parameters;  ///< At the start.
  std::size_t epochs;             ///< From the start, timed as one.

  [[nodiscard]] std::size_t count() const { return targets.size(); }
};

[[nodiscard]] PeaksProblem peaks_problem(std::size_t hidden, std::size_t epochs);

/// Checks an adaptive-rate descent (adaptive_rate.hpp): its parameters after the first epochs.
inline constexpr std::size_t kCheckedEpochs = 3;
[[nodiscard]] Check check_epochs(const PeaksProblem& problem, std::span<const float> parameters);

/// Checks a Levenberg-Marquardt step, (J^T J + mu diag(J^T J)) step = -J^T e with mu = kDamping, and half the squared
/// error of the point it leads to.
inline constexpr double kDamping = 1e-2;
struct LevenbergMarquardtStep {
  std::vector<double> step;
  double trial_error = 0.0;
};
[[nodiscard]] Check check_step(const PeaksProblem& problem, const LevenbergMarquardtStep& step);

/// One network 8-16-16-1 (tanh, linear output) for all taxels of a large skin; inputs and outputs row-major.
struct TaxelProblem {
  paper::NetworkShape shape;
  std::vector<float> inputs;  ///< [taxels, 8]
  std::vector<float> parameters;

  [[nodiscard]] std::size_t taxels() const { return inputs.size() / shape.inputs; }
};

[[nodiscard]] TaxelProblem taxel_problem(std::size_t taxels);
[[nodiscard]] Check check_outputs(const TaxelProblem& problem, std::span<const float> outputs);

/// The paper's networks: for each taxel one N-N-N-1 network of sigmoids that sees all N taxels.
struct BankProblem {
  paper::NetworkShape shape;
  std::size_t networks;
  std::vector<float> all_parameters;  ///< [networks, parameter_count]
  std::size_t batch;
  std::vector<float> frames;    ///< [batch, inputs]; bank_frame takes the first.
  std::vector<float> database;  ///< To train on, [patterns, inputs], and [patterns, networks].
  std::vector<float> targets;
  std::vector<std::uint32_t> chosen;  ///< Rows of the database, [networks, batch].

  [[nodiscard]] std::size_t size() const { return shape.inputs; }
  [[nodiscard]] std::size_t patterns() const { return database.size() / size(); }
  [[nodiscard]] std::span<const float> parameters(std::size_t network) const {
    return std::span(all_parameters).subspan(network * shape.parameter_count(), shape.parameter_count());
  }
  /// Floating-point operations of one pass over the weights for `count` patterns: a multiplication and an addition
  /// each.
  [[nodiscard]] double operations(std::size_t count) const;
};

[[nodiscard]] BankProblem bank_problem(std::size_t size, std::size_t networks);

/// Of the first `count` frames: outputs [count, networks], compared for some of the networks.
[[nodiscard]] Check check_outputs(const BankProblem& problem, std::size_t count, std::span<const float> outputs);

/// The parameters after one step of the rule with these constants; some of the networks are compared.
inline constexpr float kDescentRate = 0.1F;
inline constexpr float kAdamRate = 0.001F;
[[nodiscard]] Check check_training_step(const BankProblem& problem, Rule rule,
                                        const std::function<std::vector<float>(std::size_t network)>& parameters);

}  // namespace dermis::benchmarks
