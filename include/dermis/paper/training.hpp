// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "dermis/paper/network_shape.hpp"
#include "dermis/paper/samples.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// The training of one network, Fig. 9 of the paper.
///
/// "Error" is everywhere the mean square of eq. (2): sum_p w_p sum_k (t_pk - o_pk)^2 / (outputs sum_p w_p).
/// An epoch is one pass over all patterns; the error of an epoch is that of the parameters at its end.

/// How the parameters w move against the error. Full batch: one step an epoch, from all patterns.
enum class TrainingAlgorithm : std::uint8_t {
  /// The paper's back propagation, batches of any size. With g the gradient of 1/batch times eq. (6) of the batch (of
  /// eq. (5) for a single pattern): `step = momentum step - rate g`, `w += step`.
  gradient_descent,

  /// Gradient descent with momentum and adaptive rate, full batch: the rules of MATLAB's traingdx. With g the gradient
  /// of the error E, and step = -rate g before the first epoch:
  ///   step = momentum step - (1 - momentum) rate g
  ///   E(w + step) > max_error_increase E(w), or not finite: the step is discarded, rate *= rate_decrease, and the
  ///     momentum is zeroed: step = -rate g, so that the next epoch goes along the gradient alone;
  ///   else w += step, and where the error fell, rate *= rate_increase.
  adaptive_rate,

  /// iRPROP- (Igel and Huesken 2000), full batch. Each parameter has a step size, 0.1 at the start. The step size is
  /// multiplied by 1.2 (to at most 50) if the derivative keeps its sign, and by 0.5 (to at least 1e-6) otherwise. After
  /// a change the derivative counts as 0 in this epoch and the next. w moves by the step size against the sign of its
  /// derivative.
  resilient_propagation,

  /// Scaled conjugate gradient (Moller 1993), full batch; sigma = 1e-4 and lambda = 1e-6 at the start.
  conjugate_gradient,

  /// Full batch, double precision, at most 4,096 unknowns; an epoch is one accepted or refused step. See
  /// levenberg_marquardt.hpp.
  levenberg_marquardt,

  /// Adam (Kingma and Ba 2015), batches of any size, along the g of gradient_descent; decays 0.9 and 0.999,
  /// epsilon 1e-8.
  adam,
};

/// "gradient_descent", "adaptive_rate" and so on.
[[nodiscard]] std::string_view name(TrainingAlgorithm algorithm) noexcept;

struct TrainingOptions {
  TrainingAlgorithm algorithm = TrainingAlgorithm::adaptive_rate;
  std::size_t batch = 0;             ///< Patterns a step; 0: all. Others than 0 for gradient_descent and adam only.
  double rate = 0.01;                ///< > 0; adaptive_rate begins with it; gradient_descent and adam keep it.
  double momentum = 0.9;             ///< 0 <= momentum < 1; gradient_descent and adaptive_rate.
  double rate_increase = 1.05;       ///< >= 1
  double rate_decrease = 0.7;        ///< 0 < rate_decrease < 1
  double max_error_increase = 1.04;  ///< >= 1
  std::uint64_t epochs = 10'000;     ///< Stop when so many are done, counted from the start of the training.
  double error_goal = 0.0;           ///< Stop at an error this small, >= 0; the paper's epsilon in eq. (2).
  /// Stop where no |dE/dparameter| is greater, >= 0. Full batch only (0 with a batch).
  double gradient_limit = 0.0;
  /// Stop when so many epochs brought no lower error on the validation samples, >= 1. Without these, no meaning.
  std::uint64_t patience = 20;
  std::uint64_t seed = 1;  ///< Seed of the order of the patterns, drawn anew each epoch where there are batches.

  /// Names the first field that is out of its range.
  [[nodiscard]] Status validate() const;
};

/// The error after each epoch, thinned so that it stays small: value i belongs to epoch i * stride, 0 being the start.
/// The stride doubles whenever kMaxValues are there.
struct ErrorCurve {
  static constexpr std::size_t kMaxValues = 16'384;

  std::uint64_t stride = 1;
  std::vector<double> errors;
  std::vector<double> validation_errors;  ///< As many, or empty where there are no validation samples.

  bool operator==(const ErrorCurve&) const = default;
};

/// All that a training knows between two epochs: plain data. Stopped and resumed, on the same samples and options, it
/// gives the same bits as in one run. Made by start_training(), moved on by train().
template <std::floating_point Real>
struct TrainingState {
  NetworkShape shape;
  TrainingAlgorithm algorithm = TrainingAlgorithm::adaptive_rate;
  std::uint64_t seed = 1;
  std::uint64_t epoch = 0;            ///< Done so far.
  std::vector<Real> parameters;       ///< w
  double error = 0.0;                 ///< At the parameters, once train() has seen the samples.
  double validation_error = 0.0;      ///< The same on the validation samples; 0 where there are none.
  std::vector<Real> best_parameters;  ///< The result: of the lowest validation error, without validation samples
                                      ///< of the lowest error.
  double best_error = std::numeric_limits<double>::infinity();  ///< That error; infinity before the first.
  std::uint64_t best_epoch = 0;
  ErrorCurve curve;
  /// The memory of the algorithm, in rows of parameter_count(). gradient_descent, adaptive_rate: the last step;
  /// resilient_propagation: last derivatives, step sizes; conjugate_gradient: direction; adam: first and second moment.
  std::vector<Real> memory;
  /// adaptive_rate: rate; conjugate_gradient: lambda, curvature (0: to be measured), steps since the last restart;
  /// levenberg_marquardt: damping; adam: steps.
  std::vector<double> numbers;

  bool operator==(const TrainingState&) const = default;
};

/// The state before the first epoch. The shape must be valid and `parameters` of its size (see initialisation.hpp).
template <std::floating_point Real>
[[nodiscard]] TrainingState<Real> start_training(const NetworkShape& shape, std::vector<Real> parameters,
                                                 const TrainingOptions& options);

/// Whether a state belongs to this shape and algorithm and is whole: sizes that fit, parameters and memory finite. The
/// error names what differs.
template <std::floating_point Real>
[[nodiscard]] Status check_state(const TrainingState<Real>& state, const NetworkShape& shape,
                                 TrainingAlgorithm algorithm);

enum class StopReason : std::uint8_t {
  error_goal,
  gradient_limit,
  no_descent,   ///< No step lowers the error any more, however short: a minimum, to the precision of the numbers.
  validation,   ///< Patience is at its end.
  epoch_limit,  ///< The goal was not met.
  callback,     ///< It said so.
  diverged,     ///< The error is not finite; the best point is kept; train on from that one.
};

/// "error_goal", "gradient_limit" and so on.
[[nodiscard]] std::string_view name(StopReason reason) noexcept;

struct TrainingReport {
  StopReason stop = StopReason::epoch_limit;
  std::vector<std::size_t> constant_inputs;  ///< Inputs with one value in all patterns: nothing is learned from them.
  bool underdetermined = false;              ///< Fewer target values than unknowns: the network can learn by heart.
};

/// Called after each epoch with the state as it could be resumed; false stops.
template <std::floating_point Real>
using TrainingCallback = std::function<bool(const TrainingState<Real>& state)>;

/// Trains from `state` on; what was learned is state.best_parameters. Errors: options, samples (check_samples) or
/// state (check_state) that cannot be used; the state is then as it was. Allocates nothing between the first epoch and
/// the last, levenberg_marquardt excepted. Uses one thread; thread-safe for different states.
template <std::floating_point Real>
[[nodiscard]] Result<TrainingReport> train(TrainingState<Real>& state, const Samples<Real>& samples,
                                           const TrainingOptions& options, const Samples<Real>& validation = {},
                                           const TrainingCallback<Real>& callback = {});

}  // namespace dermis::paper
