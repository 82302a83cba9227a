// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/training.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "dermis/core/random.hpp"
#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/paper/levenberg_marquardt.hpp"
#include "paper/training/pattern_descent.hpp"

namespace dermis::paper {
namespace {

constexpr double kMaxRate = 1e30;  // of adaptive_rate; keeps it finite where every epoch lowers the error

constexpr std::size_t kMaxLevenbergMarquardtUnknowns = 4096;  // whose normal equations take 128 MiB

constexpr double kFirstStepSize = 0.1;  // resilient propagation
constexpr double kLeastStepSize = 1e-6;
constexpr double kGreatestStepSize = 50.0;
constexpr double kStepSizeIncrease = 1.2;
constexpr double kStepSizeDecrease = 0.5;

constexpr double kSigma = 1e-4;  // conjugate gradient
constexpr double kFirstLambda = 1e-6;
constexpr double kLeastLambda = 1e-20;

constexpr double kFirstDecay = 0.9;  // Adam
constexpr double kSecondDecay = 0.999;
constexpr double kEpsilon = 1e-8;

/// Rows of TrainingState::memory and count of TrainingState::numbers.
struct Memory {
  std::string_view name;
  std::size_t rows;
  std::size_t numbers;
};

constexpr std::array<Memory, 6> kAlgorithms = {{{"gradient_descent", 1, 0},
                                                {"adaptive_rate", 1, 1},
                                                {"resilient_propagation", 2, 0},
                                                {"conjugate_gradient", 1, 3},
                                                {"levenberg_marquardt", 0, 1},
                                                {"adam", 2, 1}}};

const Memory& memory_of(TrainingAlgorithm algorithm) {
  return kAlgorithms.at(static_cast<std::size_t>(algorithm));
}

bool takes_batches(TrainingAlgorithm algorithm) {
  return algorithm == TrainingAlgorithm::gradient_descent || algorithm == TrainingAlgorithm::adam;
}

template <typename Real>
Status check_numbers(const char* what, const std::vector<Real>& numbers, std::size_t count) {
  if (numbers.size() != count) {
    return bad_input(std::string("training state: has ") + std::to_string(numbers.size()) + " " + what + ", not " +
                     std::to_string(count));
  }
  const auto bad = std::find_if_not(numbers.begin(), numbers.end(), [](Real value) { return std::isfinite(value); });
  if (bad == numbers.end()) return Done{};
  return bad_input("training state: number " + std::to_string(bad - numbers.begin()) + " of its " + what +
                   " is not finite; start again from the best parameters");
}

Status check_curve(const ErrorCurve& curve, std::uint64_t epoch) {
  const std::size_t values = curve.errors.size();
  const bool is_fresh = values == 0 && epoch == 0;
  if (values > ErrorCurve::kMaxValues || curve.stride == 0 || (!is_fresh && values != epoch / curve.stride + 1)) {
    return bad_input("training state: a curve of " + std::to_string(values) + " errors, one in " +
                     std::to_string(curve.stride) + ", does not fit its epoch " + std::to_string(epoch));
  }
  if (!curve.validation_errors.empty() && curve.validation_errors.size() != values) {
    return bad_input("training state: the curves have different lengths");
  }
  return Done{};
}

/// 1 / sum_p w_p, over outputs: what turns sum_p w_p sum_k (t_pk - o_pk)^2 into the mean square.
template <typename Real>
double mean_factor(const Samples<Real>& samples, std::size_t outputs) {
  const double weights = samples.weights.empty() ? static_cast<double>(samples.count)
                                                 : std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0);
  return 1.0 / (weights * static_cast<double>(outputs));
}

template <typename Real>
double dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                            [](Real x, Real y) { return double{x} * double{y}; });
}

/// One call of train().
template <std::floating_point Real>
class Run {
 public:
  Run(TrainingState<Real>& state, const Samples<Real>& samples, const TrainingOptions& options,
      const Samples<Real>& validation, const TrainingCallback<Real>& callback)
      : state_(state),
        samples_(samples),
        options_(options),
        callback_(callback),
        network_(state.shape),
        packed_(state.shape, samples),
        scale_(2.0 * mean_factor(samples, state.shape.outputs())),
        validates_(validation.count > 0),
        in_batches_(options.batch != 0 && options.batch < samples.count) {
    const std::size_t n = state.parameters.size();
    if (validates_) {
      packed_validation_ = PackedSamples<Real>(state.shape, validation);
      validation_scale_ = 2.0 * mean_factor(validation, state.shape.outputs());
    }
    if (state.algorithm != TrainingAlgorithm::levenberg_marquardt) gradient_.resize(n);
    trial_.resize(n);
    trial_gradient_.resize(n);
    if (in_batches_) order_.resize(samples.count);
    if (by_pattern()) pattern_descent_.emplace(state.shape);
    const auto values =
        static_cast<std::size_t>(std::min<std::uint64_t>(options.epochs, ErrorCurve::kMaxValues - 1)) + 1;
    state.curve.errors.reserve(values);
    if (validates_) state.curve.validation_errors.reserve(values);
  }

  StopReason run() {
    begin();
    if constexpr (std::same_as<Real, double>) {
      if (state_.algorithm == TrainingAlgorithm::levenberg_marquardt) return run_levenberg_marquardt();
    }
    std::optional<StopReason> stop = reason_to_stop();
    while (!stop) {
      run_epoch();
      stop = finish_epoch();
    }
    return *stop;
  }

 private:
  [[nodiscard]] bool by_pattern() const {
    return in_batches_ && options_.batch == 1 && state_.algorithm == TrainingAlgorithm::gradient_descent;
  }
  [[nodiscard]] bool knows_gradient() const { return !in_batches_ && !gradient_.empty(); }

  double evaluate(const std::vector<Real>& parameters, std::vector<Real>& gradient) {
    return scale_ * network_.error_and_gradient(parameters, packed_, gradient);
  }

  std::span<Real> memory_row(std::size_t row) {
    const std::size_t n = state_.parameters.size();
    return std::span(state_.memory).subspan(row * n, n);
  }

  void begin() {
    const double error =
        knows_gradient() ? evaluate(state_.parameters, gradient_) : scale_ * network_.error(state_.parameters, packed_);
    if (!state_.curve.errors.empty()) return;
    state_.error = error;
    if (state_.algorithm == TrainingAlgorithm::adaptive_rate) forget_momentum();
    if (state_.algorithm == TrainingAlgorithm::conjugate_gradient) go_downhill();
    record();
  }

  [[nodiscard]] std::optional<StopReason> reason_to_stop() const {
    if (!std::isfinite(state_.error) || !std::isfinite(state_.validation_error)) return StopReason::diverged;
    if (state_.error <= options_.error_goal) return StopReason::error_goal;
    if (knows_gradient()) {
      const auto is_finite = [](Real value) { return std::isfinite(value); };
      const auto is_small = [this](Real value) { return scale_ * std::abs(double{value}) <= options_.gradient_limit; };
      if (!std::all_of(gradient_.begin(), gradient_.end(), is_finite)) return StopReason::diverged;
      if (std::all_of(gradient_.begin(), gradient_.end(), is_small)) return StopReason::gradient_limit;
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
    if (validates_) state_.validation_error = validation_scale_ * network_.error(state_.parameters, packed_validation_);
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

  void run_epoch() {
    switch (state_.algorithm) {
      case TrainingAlgorithm::gradient_descent:
      case TrainingAlgorithm::adam: in_batches_ ? batch_epoch() : full_batch_epoch(); break;
      case TrainingAlgorithm::adaptive_rate: adaptive_rate_epoch(); break;
      case TrainingAlgorithm::resilient_propagation: resilient_propagation_epoch(); break;
      case TrainingAlgorithm::conjugate_gradient: conjugate_gradient_epoch(); break;
      case TrainingAlgorithm::levenberg_marquardt: break;  // run_levenberg_marquardt()
    }
  }

  void full_batch_epoch() {
    take_step(samples_.count);
    state_.error = evaluate(state_.parameters, gradient_);
  }

  void batch_epoch() {
    shuffle();
    if (pattern_descent_) {
      const auto rate = static_cast<Real>(options_.rate);
      const auto momentum = static_cast<Real>(options_.momentum);
      pattern_descent_->epoch({samples_, order_, rate, momentum}, state_.parameters, state_.memory);
    } else {
      for (std::size_t first = 0; first < order_.size(); first += options_.batch) {
        const std::size_t count = std::min(options_.batch, order_.size() - first);
        packed_batch_.pack(state_.shape, samples_, std::span(order_).subspan(first, count));
        network_.error_and_gradient(state_.parameters, packed_batch_, gradient_);
        take_step(count);
      }
    }
    state_.error = scale_ * network_.error(state_.parameters, packed_);
  }

  /// The order of an epoch depends on the seed and its number alone (Fisher and Yates).
  void shuffle() {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    Random random = Random::stream(state_.seed, state_.epoch);
    for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random.below(i)]);
  }

  /// From gradient_, which is of eq. (6) over so many patterns.
  void take_step(std::size_t patterns) {
    const Real share = Real{1} / static_cast<Real>(patterns);
    if (state_.algorithm == TrainingAlgorithm::adam) {
      take_adam_step(share);
    } else {
      take_momentum_step(share);
    }
  }

  void take_momentum_step(Real share) {
    const auto momentum = static_cast<Real>(options_.momentum);
    const Real rate = static_cast<Real>(options_.rate) * share;
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      state_.memory[i] = momentum * state_.memory[i] - rate * gradient_[i];
      state_.parameters[i] += state_.memory[i];
    }
  }

  void take_adam_step(Real share) {
    const double steps = ++state_.numbers[0];
    const auto first_decay = static_cast<Real>(kFirstDecay);
    const auto second_decay = static_cast<Real>(kSecondDecay);
    const auto rate = static_cast<Real>(options_.rate / (1.0 - std::pow(kFirstDecay, steps)));
    const auto second_scale = static_cast<Real>(1.0 / (1.0 - std::pow(kSecondDecay, steps)));
    const std::span<Real> first = memory_row(0);
    const std::span<Real> second = memory_row(1);
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      const Real derivative = share * gradient_[i];
      first[i] = first_decay * first[i] + (Real{1} - first_decay) * derivative;
      second[i] = second_decay * second[i] + (Real{1} - second_decay) * derivative * derivative;
      state_.parameters[i] -= rate * first[i] / (std::sqrt(second[i] * second_scale) + static_cast<Real>(kEpsilon));
    }
  }

  void move_to_trial(double error) {
    state_.parameters.swap(trial_);
    gradient_.swap(trial_gradient_);
    state_.error = error;
  }

  void forget_momentum() {
    const auto rate = static_cast<Real>(state_.numbers[0] * scale_);
    for (std::size_t i = 0; i < gradient_.size(); ++i) state_.memory[i] = -rate * gradient_[i];
  }

  void adaptive_rate_epoch() {
    double& rate = state_.numbers[0];
    const auto momentum = static_cast<Real>(options_.momentum);
    const auto along_gradient = static_cast<Real>((1.0 - options_.momentum) * rate * scale_);
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      state_.memory[i] = momentum * state_.memory[i] - along_gradient * gradient_[i];
      trial_[i] = state_.parameters[i] + state_.memory[i];
    }
    const double trial_error = evaluate(trial_, trial_gradient_);
    if (!std::isfinite(trial_error) || trial_error > options_.max_error_increase * state_.error) {
      rate *= options_.rate_decrease;
      forget_momentum();
      return;
    }
    if (trial_error < state_.error) rate = std::min(rate * options_.rate_increase, kMaxRate);
    move_to_trial(trial_error);
  }

  void resilient_propagation_epoch() {
    const std::span<Real> last = memory_row(0);
    const std::span<Real> size = memory_row(1);
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      const Real agreement = last[i] * gradient_[i];
      last[i] = gradient_[i];
      if (agreement > Real{0}) {
        size[i] = std::min(size[i] * static_cast<Real>(kStepSizeIncrease), static_cast<Real>(kGreatestStepSize));
      } else if (agreement < Real{0}) {
        size[i] = std::max(size[i] * static_cast<Real>(kStepSizeDecrease), static_cast<Real>(kLeastStepSize));
        last[i] = Real{0};
      }
      if (last[i] != Real{0}) state_.parameters[i] -= std::copysign(size[i], last[i]);
    }
    state_.error = evaluate(state_.parameters, gradient_);
  }

  void go_downhill() {
    std::transform(gradient_.begin(), gradient_.end(), state_.memory.begin(), std::negate<>());
    state_.numbers[1] = 0.0;
    state_.numbers[2] = 0.0;
  }

  void set_trial(double distance) {
    for (std::size_t i = 0; i < trial_.size(); ++i) {
      trial_[i] = state_.parameters[i] + static_cast<Real>(distance) * state_.memory[i];
    }
  }

  /// The numbers and the names are those of Moller's paper, with its delta less lambda |p|^2 as the curvature: what it
  /// calls lambda-bar is then not needed.
  void conjugate_gradient_epoch() {
    double& lambda = state_.numbers[0];
    double& curvature = state_.numbers[1];
    const std::vector<Real>& p = state_.memory;
    double mu = -dot(p, gradient_);
    if (mu == 0.0) {
      go_downhill();
      mu = dot(p, p);
    }
    const double p_square = dot(p, p);
    if (!std::isnormal(p_square)) {  // too short or too long to be measured: all below would be NaN
      no_descent_ = true;
      return;
    }
    if (curvature == 0.0) curvature = measure_curvature(p_square);
    double delta = curvature + lambda * p_square;
    if (delta <= 0.0) {
      lambda = std::max(-2.0 * curvature / p_square, kLeastLambda);
      delta = curvature + lambda * p_square;
    }
    set_trial(mu / delta);
    const double trial_error = evaluate(trial_, trial_gradient_);
    const double reduction = (state_.error - trial_error) / scale_;
    const double comparison = std::isfinite(trial_error) ? 2.0 * delta * reduction / (mu * mu) : -1.0;
    if (comparison >= 0.0) {
      no_descent_ = trial_ == state_.parameters;
      move_to_trial(trial_error);
      turn(mu);
    }
    if (comparison >= 0.75) lambda = std::max(0.25 * lambda, kLeastLambda);
    if (comparison < 0.25) lambda += delta * (1.0 - comparison) / p_square;
  }

  double measure_curvature(double p_square) {
    const double sigma = kSigma / std::sqrt(p_square);
    set_trial(sigma);
    evaluate(trial_, trial_gradient_);
    return (dot(state_.memory, trial_gradient_) - dot(state_.memory, gradient_)) / sigma;
  }

  /// The next direction; trial_gradient_ is the gradient before the step.
  void turn(double mu) {
    if (++state_.numbers[2] >= static_cast<double>(gradient_.size())) {
      go_downhill();
      return;
    }
    const double beta = (dot(gradient_, gradient_) - dot(gradient_, trial_gradient_)) / mu;
    state_.numbers[1] = 0.0;
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      state_.memory[i] = static_cast<Real>(beta) * state_.memory[i] - gradient_[i];
    }
  }

  StopReason run_levenberg_marquardt() {
    using network::LevenbergMarquardtStop;
    std::optional<StopReason> stop = reason_to_stop();
    if (stop) return *stop;
    network::LevenbergMarquardtOptions options;
    options.max_iterations =
        static_cast<int>(std::min<std::uint64_t>(options_.epochs - state_.epoch, std::numeric_limits<int>::max()));
    options.gradient_limit = options_.gradient_limit / scale_;
    options.relative_reduction = 0.0;
    options.initial_damping = state_.numbers[0];
    options.observer = [&](int, double error, double damping) {
      state_.error = scale_ * error;
      state_.numbers[0] = damping;
      stop = finish_epoch();
      return !stop;
    };
    const network::LevenbergMarquardtReport report = minimise(network_, packed_, state_.parameters, options);
    if (stop) return *stop;
    switch (report.stop) {
      case LevenbergMarquardtStop::error_goal: return StopReason::error_goal;
      case LevenbergMarquardtStop::gradient_limit: return StopReason::gradient_limit;
      case LevenbergMarquardtStop::not_finite: return StopReason::diverged;
      default: return StopReason::no_descent;
    }
  }

  TrainingState<Real>& state_;
  const Samples<Real>& samples_;
  const TrainingOptions& options_;
  const TrainingCallback<Real>& callback_;
  FeedForward<Real> network_;
  PackedSamples<Real> packed_;
  PackedSamples<Real> packed_validation_;
  PackedSamples<Real> packed_batch_;
  std::optional<PatternDescent<Real>> pattern_descent_;
  double scale_;  ///< From eq. (6) to eq. (2).
  double validation_scale_ = 0.0;
  bool validates_;
  bool in_batches_;
  bool no_descent_ = false;
  std::vector<std::size_t> order_;
  std::vector<Real> gradient_;  ///< Of eq. (6), all patterns: at the parameters, between epochs.
  std::vector<Real> trial_;
  std::vector<Real> trial_gradient_;
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

std::string_view name(TrainingAlgorithm algorithm) noexcept {
  return memory_of(algorithm).name;
}

std::string_view name(StopReason reason) noexcept {
  constexpr std::array<std::string_view, 7> kNames = {"error_goal",  "gradient_limit", "no_descent", "validation",
                                                      "epoch_limit", "callback",       "diverged"};
  return kNames.at(static_cast<std::size_t>(reason));
}

Status TrainingOptions::validate() const {
  const auto wrong = [](const char* what) { return bad_input(std::string("training.") + what); };
  if (algorithm > TrainingAlgorithm::adam) return wrong("algorithm: unknown");
  if (batch != 0 && !takes_batches(algorithm)) {
    return wrong("batch: must be 0, as this algorithm takes all patterns; gradient_descent and adam take batches");
  }
  if (!(rate > 0.0) || !std::isfinite(rate)) return wrong("rate: must be greater than 0");
  if (!(momentum >= 0.0 && momentum < 1.0)) return wrong("momentum: must be at least 0 and less than 1");
  if (!(rate_increase >= 1.0) || !std::isfinite(rate_increase)) return wrong("rate_increase: must be at least 1");
  if (!(rate_decrease > 0.0 && rate_decrease < 1.0)) return wrong("rate_decrease: must be between 0 and 1");
  if (!(max_error_increase >= 1.0) || !std::isfinite(max_error_increase)) {
    return wrong("max_error_increase: must be at least 1");
  }
  if (!(error_goal >= 0.0)) return wrong("error_goal: must be at least 0");
  if (!(gradient_limit >= 0.0)) return wrong("gradient_limit: must be at least 0");
  if (gradient_limit > 0.0 && batch != 0) return wrong("gradient_limit: must be 0 where there is a batch");
  if (patience == 0) return wrong("patience: must be at least 1");
  return Done{};
}

template <std::floating_point Real>
TrainingState<Real> start_training(const NetworkShape& shape, std::vector<Real> parameters,
                                   const TrainingOptions& options) {
  assert(shape.validate() && parameters.size() == shape.parameter_count());
  TrainingState<Real> state;
  state.shape = shape;
  state.algorithm = options.algorithm;
  state.seed = options.seed;
  state.best_parameters = parameters;
  const std::size_t n = parameters.size();
  state.parameters = std::move(parameters);
  state.memory.resize(memory_of(options.algorithm).rows * n);
  state.numbers.resize(memory_of(options.algorithm).numbers);
  switch (options.algorithm) {
    case TrainingAlgorithm::adaptive_rate: state.numbers[0] = options.rate; break;
    case TrainingAlgorithm::resilient_propagation:
      std::fill_n(&state.memory[n], n, static_cast<Real>(kFirstStepSize));
      break;
    case TrainingAlgorithm::conjugate_gradient: state.numbers[0] = kFirstLambda; break;
    case TrainingAlgorithm::levenberg_marquardt:
      state.numbers[0] = network::LevenbergMarquardtOptions{}.initial_damping;
      break;
    default: break;
  }
  return state;
}

template <std::floating_point Real>
Status check_state(const TrainingState<Real>& state, const NetworkShape& shape, TrainingAlgorithm algorithm) {
  if (Status valid = state.shape.validate(); !valid) return valid;
  if (state.shape != shape) {
    return bad_input("training state: is of a network " + state.shape.describe() + ", not " + shape.describe());
  }
  if (state.algorithm > TrainingAlgorithm::adam) return bad_input("training state: its algorithm is unknown");
  if (state.algorithm != algorithm) {
    return bad_input("training state: is of " + std::string(name(state.algorithm)) + ", not " +
                     std::string(name(algorithm)));
  }
  const std::size_t n = state.shape.parameter_count();
  if (Status good = check_numbers("parameters", state.parameters, n); !good) return good;
  if (Status good = check_numbers("best parameters", state.best_parameters, n); !good) return good;
  if (Status good = check_numbers("memory", state.memory, memory_of(algorithm).rows * n); !good) return good;
  if (Status good = check_numbers("numbers", state.numbers, memory_of(algorithm).numbers); !good) return good;
  if (std::isnan(state.best_error)) return bad_input("training state: its best error is not a number");
  if (state.best_epoch > state.epoch) return bad_input("training state: its best epoch is yet to come");
  return check_curve(state.curve, state.epoch);
}

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

template TrainingState<float> start_training(const NetworkShape&, std::vector<float>, const TrainingOptions&);
template TrainingState<double> start_training(const NetworkShape&, std::vector<double>, const TrainingOptions&);
template Status check_state(const TrainingState<float>&, const NetworkShape&, TrainingAlgorithm);
template Status check_state(const TrainingState<double>&, const NetworkShape&, TrainingAlgorithm);
template Result<TrainingReport> train(TrainingState<float>&, const Samples<float>&, const TrainingOptions&,
                                      const Samples<float>&, const TrainingCallback<float>&);
template Result<TrainingReport> train(TrainingState<double>&, const Samples<double>&, const TrainingOptions&,
                                      const Samples<double>&, const TrainingCallback<double>&);

}  // namespace dermis::paper
