// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "paper/training/algorithm.hpp"
#include "paper/training/pattern_descent.hpp"

namespace dermis::paper {
namespace {

constexpr double kFirstDecay = 0.9;  // Adam
constexpr double kSecondDecay = 0.999;
constexpr double kEpsilon = 1e-8;

/// gradient_descent and adam, by all patterns at once or in batches.
template <std::floating_point Real>
class GradientSteps final : public Algorithm<Real> {
 public:
  explicit GradientSteps(const TrainingPoint<Real>& point) {
    if (point.in_batches()) order_.resize(point.samples.count);
    const bool by_pattern = point.in_batches() && point.options.batch == 1;
    if (by_pattern && point.state.algorithm == TrainingAlgorithm::gradient_descent) {
      pattern_descent_.emplace(point.state.shape);
    }
  }

  bool run_epoch(TrainingPoint<Real>& point) override {
    if (point.in_batches()) {
      run_batches(point);
    } else {
      take_step(point, point.samples.count);
      point.update();
    }
    return true;
  }

 private:
  void run_batches(TrainingPoint<Real>& point) {
    TrainingState<Real>& state = point.state;
    const TrainingOptions& options = point.options;
    shuffle(state);
    if (pattern_descent_) {
      const auto rate = static_cast<Real>(options.rate);
      const auto momentum = static_cast<Real>(options.momentum);
      pattern_descent_->epoch({point.samples, order_, rate, momentum}, state.parameters, state.memory);
    } else {
      for (std::size_t first = 0; first < order_.size(); first += options.batch) {
        const std::size_t count = std::min(options.batch, order_.size() - first);
        batch_.pack(state.shape, point.samples, std::span(order_).subspan(first, count));
        point.network.error_and_gradient(state.parameters, batch_, point.gradient);
        take_step(point, count);
      }
    }
    state.error = point.error();
  }

  /// The order of an epoch depends on the seed and its number alone (Fisher and Yates).
  void shuffle(const TrainingState<Real>& state) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    Random random = Random::stream(state.seed, state.epoch);
    for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random.below(i)]);
  }

  /// Along the gradient, which is of eq. (6) over so many patterns.
  static void take_step(TrainingPoint<Real>& point, std::size_t patterns) {
    const Real share = Real{1} / static_cast<Real>(patterns);
    if (point.state.algorithm == TrainingAlgorithm::adam) {
      take_adam_step(point, share);
    } else {
      take_momentum_step(point, share);
    }
  }

  static void take_momentum_step(TrainingPoint<Real>& point, Real share) {
    TrainingState<Real>& state = point.state;
    const auto momentum = static_cast<Real>(point.options.momentum);
    const Real rate = static_cast<Real>(point.options.rate) * share;
    for (std::size_t i = 0; i < point.gradient.size(); ++i) {
      state.memory[i] = momentum * state.memory[i] - rate * point.gradient[i];
      state.parameters[i] += state.memory[i];
    }
  }

  static void take_adam_step(TrainingPoint<Real>& point, Real share) {
    const double steps = ++point.state.numbers[0];
    const auto first_decay = static_cast<Real>(kFirstDecay);
    const auto second_decay = static_cast<Real>(kSecondDecay);
    const auto rate = static_cast<Real>(point.options.rate / (1.0 - std::pow(kFirstDecay, steps)));
    const auto second_scale = static_cast<Real>(1.0 / (1.0 - std::pow(kSecondDecay, steps)));
    const std::span<Real> first = point.memory_row(0);
    const std::span<Real> second = point.memory_row(1);
    for (std::size_t i = 0; i < point.gradient.size(); ++i) {
      const Real derivative = share * point.gradient[i];
      first[i] = first_decay * first[i] + (Real{1} - first_decay) * derivative;
      second[i] = second_decay * second[i] + (Real{1} - second_decay) * derivative * derivative;
      const Real root = std::sqrt(second[i] * second_scale);
      point.state.parameters[i] -= rate * first[i] / (root + static_cast<Real>(kEpsilon));
    }
  }

  PackedSamples<Real> batch_;
  std::optional<PatternDescent<Real>> pattern_descent_;
  std::vector<std::size_t> order_;
};

}  // namespace

template <std::floating_point Real>
std::unique_ptr<Algorithm<Real>> make_gradient_steps(const TrainingPoint<Real>& point) {
  return std::make_unique<GradientSteps<Real>>(point);
}

template std::unique_ptr<Algorithm<float>> make_gradient_steps(const TrainingPoint<float>&);
template std::unique_ptr<Algorithm<double>> make_gradient_steps(const TrainingPoint<double>&);

}  // namespace dermis::paper
