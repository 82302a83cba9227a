// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/samples.hpp"
#include "dermis/paper/training.hpp"

namespace dermis::paper {

/// Where a training stands between two epochs, and the error around it.
template <std::floating_point Real>
struct TrainingPoint {
  TrainingState<Real>& state;
  const Samples<Real>& samples;
  const TrainingOptions& options;
  FeedForward<Real> network;
  PackedSamples<Real> packed;
  double scale;                ///< From eq. (6) to eq. (2).
  std::vector<Real> gradient;  ///< Gradient of eq. (6), all patterns, at the parameters; empty for levenberg_marquardt.

  /// The algorithm takes some patterns a step, so it does not know the gradient of all of them.
  [[nodiscard]] bool in_batches() const { return options.batch != 0 && options.batch < samples.count; }
  [[nodiscard]] bool knows_gradient() const { return !in_batches() && !gradient.empty(); }

  double error() { return scale * network.error(state.parameters, packed); }
  double error_and_gradient(const std::vector<Real>& parameters, std::vector<Real>& into) {
    return scale * network.error_and_gradient(parameters, packed, into);
  }
  void update() { state.error = error_and_gradient(state.parameters, gradient); }

  [[nodiscard]] std::span<Real> memory_row(std::size_t row) {
    const std::size_t count = state.parameters.size();
    return std::span(state.memory).subspan(row * count, count);
  }
};

/// Parameters that are tried before the training moves there.
template <std::floating_point Real>
struct TrialPoint {
  explicit TrialPoint(std::size_t count) : parameters(count), gradient(count) {}

  double evaluate(TrainingPoint<Real>& point) { return error = point.error_and_gradient(parameters, gradient); }

  /// Moves the training here; the trial keeps where it was.
  void accept(TrainingPoint<Real>& point) {
    point.state.parameters.swap(parameters);
    point.gradient.swap(gradient);
    point.state.error = error;
  }

  std::vector<Real> parameters;
  std::vector<Real> gradient;
  double error = 0.0;
};

/// How the parameters move in an epoch. Allocates nothing after its making. Not thread-safe.
template <std::floating_point Real>
class Algorithm {
 public:
  Algorithm() = default;
  Algorithm(const Algorithm&) = delete;
  Algorithm& operator=(const Algorithm&) = delete;
  virtual ~Algorithm() = default;

  /// Before the first epoch of a training, at its first gradient.
  virtual void begin(TrainingPoint<Real>& /*point*/) {}

  /// Moves state.parameters and sets state.error. False: no step lowers the error any more.
  [[nodiscard]] virtual bool run_epoch(TrainingPoint<Real>& point) = 0;
};

/// One algorithm a source file; the rules are in dermis/paper/training.hpp.
template <std::floating_point Real>
[[nodiscard]] std::unique_ptr<Algorithm<Real>> make_gradient_steps(const TrainingPoint<Real>& point);
template <std::floating_point Real>
[[nodiscard]] std::unique_ptr<Algorithm<Real>> make_adaptive_rate(const TrainingPoint<Real>& point);
template <std::floating_point Real>
[[nodiscard]] std::unique_ptr<Algorithm<Real>> make_resilient_propagation();
template <std::floating_point Real>
[[nodiscard]] std::unique_ptr<Algorithm<Real>> make_conjugate_gradient(const TrainingPoint<Real>& point);

}  // namespace dermis::paper
