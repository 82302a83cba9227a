// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/paper/training.hpp"
#include "dermis/touch/network/levenberg_marquardt.hpp"

namespace dermis::paper {
namespace {

constexpr double kFirstStepSize = 0.1;  // resilient propagation
constexpr double kFirstLambda = 1e-6;   // conjugate gradient

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
      state.numbers[0] = touch::network::LevenbergMarquardtOptions{}.initial_damping;
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

template TrainingState<float> start_training(const NetworkShape&, std::vector<float>, const TrainingOptions&);
template TrainingState<double> start_training(const NetworkShape&, std::vector<double>, const TrainingOptions&);
template Status check_state(const TrainingState<float>&, const NetworkShape&, TrainingAlgorithm);
template Status check_state(const TrainingState<double>&, const NetworkShape&, TrainingAlgorithm);

}  // namespace dermis::paper
