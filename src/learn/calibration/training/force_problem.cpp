// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/force_problem.hpp"

#include <algorithm>
#include <numeric>

namespace dermis::learn::calibration {

ForceProblem::ForceProblem(const touch::network::PerceptronShape& shape,
                           const touch::network::PerceptronSamples& samples, const NetworkPrior& prior, double scale)
    : shape_(shape),
      samples_(samples),
      prior_(prior),
      scale_(scale),
      parameters_(shape.parameter_count()),
      prior_residuals_(parameters_.size()),
      prior_slopes_(parameters_.size()) {}

void ForceProblem::set(std::span<const double> free) {
  touch::network::monotone::parameters(shape_, free, parameters_);
  prior_residuals(shape_, parameters_, prior_, scale_, prior_residuals_, prior_slopes_);
}

double ForceProblem::error(std::span<const double> free) {
  set(free);
  const double of_prior =
      std::inner_product(prior_residuals_.begin(), prior_residuals_.end(), prior_residuals_.begin(), 0.0);
  return samples_.error(shape_, parameters_) + 0.5 * of_prior;
}

void ForceProblem::linearise(std::span<const double> free, std::span<double> gradient, std::span<double> normal) {
  set(free);
  samples_.linearise(shape_, parameters_, gradient, normal);
  const std::size_t n = parameters_.size();
  touch::network::monotone::chain_gradient(shape_, parameters_, gradient);
  for (std::size_t p = 0; p < n; ++p) {
    const double chain = touch::network::monotone::is_positive(shape_, p) ? parameters_[p] : 1.0;
    for (std::size_t q = 0; q <= p; ++q) normal[p * n + q] *= chain;
    for (std::size_t k = p; k < n; ++k) normal[k * n + p] *= chain;
    gradient[p] += prior_slopes_[p] * prior_residuals_[p];
    normal[p * n + p] += prior_slopes_[p] * prior_slopes_[p];
  }
}

touch::network::ResidualFunction ForceProblem::residual_function() {
  return [this](std::span<const double> free, std::span<double> residuals, std::span<double> jacobian) {
    set(free);
    const std::size_t n = free.size();
    const std::size_t samples = samples_.count();
    samples_.residuals(shape_, parameters_, residuals.first(samples),
                       jacobian.first(jacobian.empty() ? 0 : samples * n));
    std::copy(prior_residuals_.begin(), prior_residuals_.end(),
              residuals.begin() + static_cast<std::ptrdiff_t>(samples));
    if (jacobian.empty()) return;
    for (std::size_t k = 0; k < samples; ++k)
      touch::network::monotone::chain_gradient(shape_, parameters_, jacobian.subspan(k * n, n));
    const std::span<double> of_prior = jacobian.subspan(samples * n);
    std::fill(of_prior.begin(), of_prior.end(), 0.0);
    for (std::size_t p = 0; p < n; ++p) of_prior[p * n + p] = prior_slopes_[p];
  };
}

std::vector<touch::network::FittedResidual> ForceProblem::fitted(std::span<const double> free,
                                                                 std::span<const std::size_t> groups) {
  return touch::network::fitted_residuals(residual_function(), samples_.count(), residual_count(), free, groups);
}

double ForceProblem::leave_one_out_mean_square(std::span<const double> free) {
  return touch::network::leave_one_out_mean_square(residual_function(), samples_.count(), residual_count(), free);
}

}  // namespace dermis::learn::calibration
