// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "calibration/recalibration/known_presses.hpp"
#include "dermis/calibration/recalibration.hpp"

namespace dermis::calibration {
namespace {

constexpr double kSheetSigma = 0.1;  // of the change of a sheet, before any press
constexpr std::size_t kLeastToTellSpread = 5;
constexpr double kMostSpread = 0.3;
constexpr int kSpreadSteps = 15;

/// sum over the taxels of the shares of two presses: how far they concern the same taxels.
Eigen::MatrixXd overlaps(std::span<const KnownPress> presses, std::size_t taxels) {
  const auto count = static_cast<Eigen::Index>(presses.size());
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(taxels));
  for (Eigen::Index k = 0; k < count; ++k) {
    const KnownPress& press = presses[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < press.taxels.size(); ++i) {
      shares(k, static_cast<Eigen::Index>(press.taxels[i])) += press.shares[i];
    }
  }
  return shares * shares.transpose();
}

/// Presses as Gaussian variables of a common covariance.
class GaussianPresses {
 public:
  GaussianPresses(std::span<const KnownPress> presses, std::size_t taxels)
      : log_ratio_(presses.size()), variance_(presses.size()), overlap_(overlaps(presses, taxels)) {
    for (std::size_t k = 0; k < presses.size(); ++k) {
      log_ratio_[static_cast<Eigen::Index>(k)] = presses[k].log_ratio;
      variance_[static_cast<Eigen::Index>(k)] = presses[k].sigma * presses[k].sigma;
    }
  }

  /// Sets the covariance to that with this spread of the taxels.
  void assume(double spread) {
    Eigen::MatrixXd covariance = spread * spread * overlap_;
    covariance.array() += kSheetSigma * kSheetSigma;
    covariance.diagonal() += variance_;
    factor_.compute(covariance);
    weights_ = factor_.solve(log_ratio_);
  }

  [[nodiscard]] double log_likelihood() const {
    return -0.5 * log_ratio_.dot(weights_) - factor_.matrixLLT().diagonal().array().log().sum();
  }

  /// Covariance^-1 times the logarithms of the ratios.
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }

  /// Variance of the change of the sheet that is left.
  [[nodiscard]] double sheet_variance() const {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(log_ratio_.size());
    const double prior = kSheetSigma * kSheetSigma;
    return prior - prior * prior * ones.dot(factor_.solve(ones));
  }

 private:
  Eigen::VectorXd log_ratio_;
  Eigen::VectorXd variance_;
  Eigen::MatrixXd overlap_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;
};

bool can_tell_spread(std::span<const KnownPress> presses) {
  return std::min(presses.size(), pressed_taxels(presses)) >= kLeastToTellSpread;
}

double likeliest_spread(GaussianPresses& presses) {
  double best = 0.0;
  double most = -std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kSpreadSteps; ++step) {
    const double spread = kMostSpread * step / kSpreadSteps;
    presses.assume(spread);
    const double likelihood = presses.log_likelihood();
    if (likelihood <= most) continue;
    most = likelihood;
    best = spread;
  }
  return best;
}

}  // namespace

GainChange change_of(std::span<const KnownPress> presses, std::size_t taxels) {
  assert(!presses.empty());
  GaussianPresses gaussian(presses, taxels);
  GainChange change;
  if (can_tell_spread(presses)) change.spread = likeliest_spread(gaussian);
  gaussian.assume(change.spread);
  change.sheet = kSheetSigma * kSheetSigma * gaussian.weights().sum();
  change.sheet_sigma = std::sqrt(gaussian.sheet_variance());
  change.taxels.assign(taxels, change.sheet);
  for (std::size_t k = 0; k < presses.size(); ++k) {
    const double weight = change.spread * change.spread * gaussian.weights()[static_cast<Eigen::Index>(k)];
    for (std::size_t i = 0; i < presses[k].taxels.size(); ++i) {
      change.taxels[presses[k].taxels[i]] += weight * presses[k].shares[i];
    }
  }
  return change;
}

}  // namespace dermis::calibration
