// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/network/levenberg_marquardt.hpp"
#include "dermis/touch/network/perceptron_samples.hpp"
#include "learn/calibration/training/force_network.hpp"

namespace dermis::learn::calibration {

/// A force network on its samples: the least-squares problem of its free parameters, the prior on them included.
class ForceProblem final : public touch::network::LeastSquaresProblem {
 public:
  /// `samples` are to outlive it. `scale`: prior_residuals().
  ForceProblem(const touch::network::PerceptronShape& shape, const touch::network::PerceptronSamples& samples,
               const NetworkPrior& prior, double scale);

  double error(std::span<const double> free) override;
  void linearise(std::span<const double> free, std::span<double> gradient, std::span<double> normal) override;

  /// The fit of each sample at the minimum `free`: touch::network::fitted_residuals().
  [[nodiscard]] std::vector<touch::network::FittedResidual> fitted(std::span<const double> free,
                                                                   std::span<const std::size_t> groups);
  [[nodiscard]] double leave_one_out_mean_square(std::span<const double> free);

 private:
  void set(std::span<const double> free);
  [[nodiscard]] std::size_t residual_count() const { return samples_.count() + parameters_.size(); }

  /// The residuals of the samples, then those of the prior.
  [[nodiscard]] touch::network::ResidualFunction residual_function();

  touch::network::PerceptronShape shape_;
  const touch::network::PerceptronSamples& samples_;
  NetworkPrior prior_;
  double scale_;
  std::vector<double> parameters_;       // those that were tried last,
  std::vector<double> prior_residuals_;  // and what the prior says of them
  std::vector<double> prior_slopes_;
};

}  // namespace dermis::learn::calibration
