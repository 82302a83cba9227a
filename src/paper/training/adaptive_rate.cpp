// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "paper/training/algorithm.hpp"

namespace dermis::paper {
namespace {

constexpr double kMaxRate = 1e30;  // keeps it finite where every epoch lowers the error

template <std::floating_point Real>
class AdaptiveRate final : public Algorithm<Real> {
 public:
  explicit AdaptiveRate(std::size_t parameters) : trial_(parameters) {}

  void begin(TrainingPoint<Real>& point) override { forget_momentum(point); }

  bool run_epoch(TrainingPoint<Real>& point) override {
    TrainingState<Real>& state = point.state;
    const TrainingOptions& options = point.options;
    double& rate = state.numbers[0];
    const auto momentum = static_cast<Real>(options.momentum);
    const auto along_gradient = static_cast<Real>((1.0 - options.momentum) * rate * point.scale);
    for (std::size_t i = 0; i < point.gradient.size(); ++i) {
      state.memory[i] = momentum * state.memory[i] - along_gradient * point.gradient[i];
      trial_.parameters[i] = state.parameters[i] + state.memory[i];
    }
    trial_.evaluate(point);
    if (!std::isfinite(trial_.error) || trial_.error > options.max_error_increase * state.error) {
      rate *= options.rate_decrease;
      forget_momentum(point);
      return true;
    }
    if (trial_.error < state.error) rate = std::min(rate * options.rate_increase, kMaxRate);
    trial_.accept(point);
    return true;
  }

 private:
  static void forget_momentum(TrainingPoint<Real>& point) {
    const auto rate = static_cast<Real>(point.state.numbers[0] * point.scale);
    for (std::size_t i = 0; i < point.gradient.size(); ++i) point.state.memory[i] = -rate * point.gradient[i];
  }

  TrialPoint<Real> trial_;
};

}  // namespace

template <std::floating_point Real>
std::unique_ptr<Algorithm<Real>> make_adaptive_rate(const TrainingPoint<Real>& point) {
  return std::make_unique<AdaptiveRate<Real>>(point.state.parameters.size());
}

template std::unique_ptr<Algorithm<float>> make_adaptive_rate(const TrainingPoint<float>&);
template std::unique_ptr<Algorithm<double>> make_adaptive_rate(const TrainingPoint<double>&);

}  // namespace dermis::paper
