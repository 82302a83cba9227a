// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace dermis::benchmarks {

/// MATLAB's traingdx with its standard constants: descent of the mean square error over all samples, with momentum and
/// a rate that adapts. The engines that have no such rule of their own use this one.
template <typename Real>
class AdaptiveRateDescent {
 public:
  /// error_and_gradient(parameters, gradient) fills the gradient of the mean square error and returns the error.
  template <typename ErrorAndGradient>
  AdaptiveRateDescent(std::span<const float> start, ErrorAndGradient&& error_and_gradient)
      : parameters_(start.begin(), start.end()),
        trial_(start.size()),
        gradient_(start.size()),
        trial_gradient_(start.size()),
        step_(start.size()) {
    error_ = error_and_gradient(std::as_const(parameters_), gradient_);
    step_along_gradient();
  }

  template <typename ErrorAndGradient>
  void epoch(ErrorAndGradient&& error_and_gradient) {
    for (std::size_t k = 0; k < step_.size(); ++k) trial_[k] = parameters_[k] + step_[k];
    const double trial_error = error_and_gradient(std::as_const(trial_), trial_gradient_);
    if (trial_error > kMaxErrorIncrease * error_) {
      rate_ *= kRateDecrease;
      step_along_gradient();
      return;
    }
    if (trial_error < error_) rate_ *= kRateIncrease;
    error_ = trial_error;
    parameters_.swap(trial_);
    gradient_.swap(trial_gradient_);
    const auto pull = static_cast<Real>(rate_ * (1.0 - kMomentum));
    for (std::size_t k = 0; k < step_.size(); ++k)
      step_[k] = static_cast<Real>(kMomentum) * step_[k] - pull * gradient_[k];
  }

  [[nodiscard]] const std::vector<Real>& parameters() const { return parameters_; }

  static constexpr double kMomentum = 0.9;
  static constexpr double kRateIncrease = 1.05;
  static constexpr double kRateDecrease = 0.7;
  static constexpr double kMaxErrorIncrease = 1.04;
  static constexpr double kFirstRate = 0.01;

 private:
  void step_along_gradient() {
    std::transform(gradient_.begin(), gradient_.end(), step_.begin(),
                   [rate = static_cast<Real>(rate_)](Real slope) { return -rate * slope; });
  }

  std::vector<Real> parameters_;
  std::vector<Real> trial_;
  std::vector<Real> gradient_;
  std::vector<Real> trial_gradient_;
  std::vector<Real> step_;
  double error_ = 0.0;
  double rate_ = kFirstRate;
};

}  // namespace dermis::benchmarks
