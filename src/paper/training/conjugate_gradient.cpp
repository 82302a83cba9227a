// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

#include "paper/training/algorithm.hpp"

namespace dermis::paper {
namespace {

constexpr double kSigma = 1e-4;
constexpr double kLeastLambda = 1e-20;

template <typename Real>
double dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                            [](Real x, Real y) { return double{x} * double{y}; });
}

/// The numbers and the names are those of Moller's paper, with its delta less lambda |p|^2 as the curvature. The
/// paper's lambda-bar is then not needed.
template <std::floating_point Real>
class ConjugateGradient final : public Algorithm<Real> {
 public:
  explicit ConjugateGradient(std::size_t parameters) : trial_(parameters) {}

  void begin(TrainingPoint<Real>& point) override { go_downhill(point); }

  bool run_epoch(TrainingPoint<Real>& point) override {
    TrainingState<Real>& state = point.state;
    double& lambda = state.numbers[0];
    double& curvature = state.numbers[1];
    const std::vector<Real>& p = state.memory;
    double mu = -dot(p, point.gradient);
    if (mu == 0.0) {
      go_downhill(point);
      mu = dot(p, p);
    }
    const double p_square = dot(p, p);
    if (!std::isnormal(p_square)) return false;  // too short or too long to be measured: all below would be NaN
    if (curvature == 0.0) curvature = measure_curvature(point, p_square);
    double delta = curvature + lambda * p_square;
    if (delta <= 0.0) {
      lambda = std::max(-2.0 * curvature / p_square, kLeastLambda);
      delta = curvature + lambda * p_square;
    }
    try_at(point, mu / delta);
    const double reduction = (state.error - trial_.error) / point.scale;
    const double comparison = std::isfinite(trial_.error) ? 2.0 * delta * reduction / (mu * mu) : -1.0;
    bool has_moved = true;
    if (comparison >= 0.0) {
      has_moved = trial_.parameters != state.parameters;
      trial_.accept(point);
      turn(point, mu);
    }
    if (comparison >= 0.75) lambda = std::max(0.25 * lambda, kLeastLambda);
    if (comparison < 0.25) lambda += delta * (1.0 - comparison) / p_square;
    return has_moved;
  }

 private:
  static void go_downhill(TrainingPoint<Real>& point) {
    std::transform(point.gradient.begin(), point.gradient.end(), point.state.memory.begin(), std::negate<>());
    point.state.numbers[1] = 0.0;
    point.state.numbers[2] = 0.0;
  }

  void try_at(TrainingPoint<Real>& point, double distance) {
    for (std::size_t i = 0; i < trial_.parameters.size(); ++i) {
      trial_.parameters[i] = point.state.parameters[i] + static_cast<Real>(distance) * point.state.memory[i];
    }
    trial_.evaluate(point);
  }

  double measure_curvature(TrainingPoint<Real>& point, double p_square) {
    const double sigma = kSigma / std::sqrt(p_square);
    try_at(point, sigma);
    return (dot(point.state.memory, trial_.gradient) - dot(point.state.memory, point.gradient)) / sigma;
  }

  /// The next direction; trial_.gradient is the gradient before the step.
  void turn(TrainingPoint<Real>& point, double mu) const {
    TrainingState<Real>& state = point.state;
    if (++state.numbers[2] >= static_cast<double>(point.gradient.size())) {
      go_downhill(point);
      return;
    }
    const double beta = (dot(point.gradient, point.gradient) - dot(point.gradient, trial_.gradient)) / mu;
    state.numbers[1] = 0.0;
    for (std::size_t i = 0; i < point.gradient.size(); ++i) {
      state.memory[i] = static_cast<Real>(beta) * state.memory[i] - point.gradient[i];
    }
  }

  TrialPoint<Real> trial_;
};

}  // namespace

template <std::floating_point Real>
std::unique_ptr<Algorithm<Real>> make_conjugate_gradient(const TrainingPoint<Real>& point) {
  return std::make_unique<ConjugateGradient<Real>>(point.state.parameters.size());
}

template std::unique_ptr<Algorithm<float>> make_conjugate_gradient(const TrainingPoint<float>&);
template std::unique_ptr<Algorithm<double>> make_conjugate_gradient(const TrainingPoint<double>&);

}  // namespace dermis::paper
