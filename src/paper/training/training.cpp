// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/training.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/initialisation.hpp"
#include "paper/training/algorithm.hpp"
#include "paper/training/levenberg_marquardt.hpp"

namespace dermis::paper {
namespace {

constexpr std::size_t kMaxLevenbergMarquardtUnknowns = 4096;  // whose normal equations take 128 MiB

/// 1 / sum_p w_p, over outputs: what turns sum_p w_p sum_k (t_pk - o_pk)^2 into the mean square.
template <typename Real>
double mean_factor(const Samples<Real>& samples, std::size_t outputs) {
  const double weights = samples.weights.empty() ? static_cast<double>(samples.count)
                                                 : std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0);
  return 1.0 / (weights * static_cast<double>(outputs));
}

/// Null for levenberg_marquardt.
template <std::floating_point Real>
std::unique_ptr<Algorithm<Real>> make_algorithm(const TrainingPoint<Real>& point) {
  switch (point.state.algorithm) {
    case TrainingAlgorithm::gradient_descent:
    case TrainingAlgorithm::adam: return make_gradient_steps(point);
    case TrainingAlgorithm::adaptive_rate: return make_adaptive_rate(point);
    case TrainingAlgorithm::resilient_propagation: return make_resilient_propagation<Real>();
    case TrainingAlgorithm::conjugate_gradient: return make_conjugate_gradient(point);
    case TrainingAlgorithm::levenberg_marquardt: break;
  }
  return nullptr;
}

/// One call of train().
template <std::floating_point Real>
class Run {
 public:
  Run(TrainingState<Real>& state, const Samples<Real>& samples, const TrainingOptions& options,
      const Samples<Real>& validation, const TrainingCallback<Real>& callback)
      : point_{.state = state,
               .samples = samples,
               .options = options,
               .network = FeedForward<Real>(state.shape),
               .packed = PackedSamples<Real>(state.shape, samples),
               .scale = 2.0 * mean_factor(samples, state.shape.outputs()),
               .gradient = {}},
        state_(state),
        options_(options),
        callback_(callback),
        validates_(validation.count > 0),
        algorithm_(make_algorithm(point_)) {
    if (validates_) {
      packed_validation_ = PackedSamples<Real>(state.shape, validation);
      validation_scale_ = 2.0 * mean_factor(validation, state.shape.outputs());
    }
    if (algorithm_) point_.gradient.resize(state.parameters.size());
    const auto values =
        static_cast<std::size_t>(std::min<std::uint64_t>(options.epochs, ErrorCurve::kMaxValues - 1)) + 1;
    state.curve.errors.reserve(values);
    if (validates_) state.curve.validation_errors.reserve(values);
  }

  StopReason run() {
    begin();
    if constexpr (std::same_as<Real, double>) {
      if (!algorithm_) return run_levenberg_marquardt();
    }
    std::optional<StopReason> stop = reason_to_stop();
    while (!stop) {
      no_descent_ = !algorithm_->run_epoch(point_);
      stop = finish_epoch();
    }
    return *stop;
  }

 private:
  void begin() {
    const double error =
        point_.knows_gradient() ? point_.error_and_gradient(state_.parameters, point_.gradient) : point_.error();
    if (!state_.curve.errors.empty()) return;
    state_.error = error;
    if (algorithm_) algorithm_->begin(point_);
    record();
  }

  [[nodiscard]] std::optional<StopReason> reason_to_stop() const {
    if (!std::isfinite(state_.error) || !std::isfinite(state_.validation_error)) return StopReason::diverged;
    if (state_.error <= options_.error_goal) return StopReason::error_goal;
    if (point_.knows_gradient()) {
      const auto is_finite = [](Real value) { return std::isfinite(value); };
      const auto is_small = [this](Real value) {
        return point_.scale * std::abs(double{value}) <= options_.gradient_limit;
      };
      if (!std::all_of(point_.gradient.begin(), point_.gradient.end(), is_finite)) return StopReason::diverged;
      if (std::all_of(point_.gradient.begin(), point_.gradient.end(), is_small)) return StopReason::gradient_limit;
    }
    if (no_descent_) return StopReason::no_descent;
    if (validates_ && state_.epoch - state_.best_epoch >= options_.patience) return StopReason::validation;
    if (state_.epoch >= options_.epochs) return StopReason::epoch_limit;
    return std::nullopt;
  }

  std::optional<StopReason> finish_epoch() {
    ++state_.epoch;
    record();
    const std::optional<StopReason> stop = reason_to_stop();
    if (stop == StopReason::diverged || !callback_ || callback_(state_)) return stop;
    return stop.value_or(StopReason::callback);
  }

  void record() {
    if (validates_)
      state_.validation_error = validation_scale_ * point_.network.error(state_.parameters, packed_validation_);
    const double judged = validates_ ? state_.validation_error : state_.error;
    if (judged < state_.best_error) {
      state_.best_error = judged;
      state_.best_epoch = state_.epoch;
      state_.best_parameters = state_.parameters;
    }
    ErrorCurve& curve = state_.curve;
    if (curve.errors.size() == ErrorCurve::kMaxValues) thin(curve);
    if (state_.epoch % curve.stride != 0) return;
    curve.errors.push_back(state_.error);
    if (validates_) curve.validation_errors.push_back(state_.validation_error);
  }

  static void thin(ErrorCurve& curve) {
    const auto keep_every_second = [](std::vector<double>& values) {
      for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
      values.resize((values.size() + 1) / 2);
    };
    keep_every_second(curve.errors);
    keep_every_second(curve.validation_errors);
    curve.stride *= 2;
  }

  StopReason run_levenberg_marquardt() {
    using touch::network::LevenbergMarquardtStop;
    std::optional<StopReason> stop = reason_to_stop();
    if (stop) return *stop;
    touch::network::LevenbergMarquardtOptions options;
    options.max_iterations =
        static_cast<int>(std::min<std::uint64_t>(options_.epochs - state_.epoch, std::numeric_limits<int>::max()));
    options.gradient_limit = options_.gradient_limit / point_.scale;
    options.relative_reduction = 0.0;
    options.initial_damping = state_.numbers[0];
    options.observer = [&](int, double error, double damping) {
      state_.error = point_.scale * error;
      state_.numbers[0] = damping;
      stop = finish_epoch();
      return !stop;
    };
    const touch::network::LevenbergMarquardtReport report =
        minimise(point_.network, point_.packed, state_.parameters, options);
    if (stop) return *stop;
    switch (report.stop) {
      case LevenbergMarquardtStop::error_goal: return StopReason::error_goal;
      case LevenbergMarquardtStop::gradient_limit: return StopReason::gradient_limit;
      case LevenbergMarquardtStop::not_finite: return StopReason::diverged;
      default: return StopReason::no_descent;
    }
  }

  TrainingPoint<Real> point_;
  TrainingState<Real>& state_;
  const TrainingOptions& options_;
  const TrainingCallback<Real>& callback_;
  bool validates_;
  bool no_descent_ = false;
  std::unique_ptr<Algorithm<Real>> algorithm_;  ///< Null: levenberg_marquardt, which steps by itself.
  PackedSamples<Real> packed_validation_;
  double validation_scale_ = 0.0;
};

template <typename Real>
Status check_request(const TrainingState<Real>& state, const Samples<Real>& samples, const TrainingOptions& options,
                     const Samples<Real>& validation) {
  if (Status valid = options.validate(); !valid) return valid;
  if (Status valid = check_state(state, state.shape, options.algorithm); !valid) return valid;
  if (Status valid = check_samples(samples, state.shape.inputs, state.shape.outputs()); !valid) return valid;
  if (options.algorithm == TrainingAlgorithm::levenberg_marquardt) {
    if (!std::same_as<Real, double>) return bad_input("training: levenberg_marquardt needs double precision");
    if (state.parameters.size() > kMaxLevenbergMarquardtUnknowns) {
      return bad_input("training: levenberg_marquardt takes at most 4096 unknowns, a network " +
                       state.shape.describe() + " has " + std::to_string(state.parameters.size()) +
                       "; use conjugate_gradient");
    }
  }
  if (!state.curve.errors.empty() && state.curve.validation_errors.empty() == (validation.count > 0)) {
    return bad_input(std::string("training state: began with") + (validation.count > 0 ? "out" : "") +
                     " validation samples and must go on so");
  }
  if (validation.count == 0) return Done{};
  const Status valid = check_samples(validation, state.shape.inputs, state.shape.outputs());
  return valid ? valid : bad_input("validation " + valid.error().message);
}

template <typename Real>
std::vector<std::size_t> constant_inputs(const Samples<Real>& samples, std::size_t inputs) {
  const std::vector<InputRange> ranges = input_ranges(samples, inputs);
  std::vector<std::size_t> constant;
  for (std::size_t input = 0; input < inputs; ++input) {
    if (ranges[input].least == ranges[input].greatest) constant.push_back(input);
  }
  return constant;
}

}  // namespace

template <std::floating_point Real>
Result<TrainingReport> train(TrainingState<Real>& state, const Samples<Real>& samples, const TrainingOptions& options,
                             const Samples<Real>& validation, const TrainingCallback<Real>& callback) {
  if (const Status valid = check_request(state, samples, options, validation); !valid) return valid.error();
  TrainingReport report;
  report.constant_inputs = constant_inputs(samples, state.shape.inputs);
  report.underdetermined = samples.targets.size() < state.parameters.size();
  report.stop = Run<Real>(state, samples, options, validation, callback).run();
  return report;
}

template Result<TrainingReport> train(TrainingState<float>&, const Samples<float>&, const TrainingOptions&,
                                      const Samples<float>&, const TrainingCallback<float>&);
template Result<TrainingReport> train(TrainingState<double>&, const Samples<double>&, const TrainingOptions&,
                                      const Samples<double>&, const TrainingCallback<double>&);

}  // namespace dermis::paper
