// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <cmath>

#include "touch/contacts/patch_fit.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr double kRadiusStep = 0.8;  // in standard deviations of the logarithm of the radius
constexpr double kLeastRadiusStep = 0.01;
constexpr double kMostRadiusStep = 0.25;
constexpr int kMostRadii = 8;          // to either side
constexpr double kLeastWeight = 0.02;  // of that of the most likely radius: further ones are left out
constexpr double kSmallStep = 0.1;     // in radii of a taxel
constexpr double kLongestStep = 1.0;

/// The best place of a patch of one radius, to second order about `patch`.
class BestPlace {
 public:
  BestPlace(const Patch& about, const NormalEquations& normal) : patch(about), chi_squared(normal.chi_squared) {
    patch.newtons = static_cast<float>(normal.newtons);
    const double xx = std::max(normal.matrix[0], 0.0) + 1e-9;
    const double xy = normal.matrix[1];
    const double yy = std::max(normal.matrix[2], 0.0) + 1e-9;
    determinant = std::max(xx * yy - xy * xy, 1e-6 * xx * yy);
    variance_x = yy / determinant;
    variance_y = xx / determinant;
    const double covariance = -xy / determinant;
    const double step_x = variance_x * normal.slope[0] + covariance * normal.slope[1];
    const double step_y = covariance * normal.slope[0] + variance_y * normal.slope[1];
    step = std::abs(step_x) + std::abs(step_y);
    patch.x += static_cast<float>(std::clamp(step_x, -kLongestStep, kLongestStep));
    patch.y += static_cast<float>(std::clamp(step_y, -kLongestStep, kLongestStep));
    x_per_radius_ = -variance_x * normal.matrix[3] - covariance * normal.matrix[4];
    y_per_radius_ = -covariance * normal.matrix[3] - variance_y * normal.matrix[4];
    chi_squared -= step_x * normal.slope[0] + step_y * normal.slope[1];
  }

  /// Where the best place of a patch larger by `log_radius` is to be expected.
  [[nodiscard]] Patch larger_by(double log_radius) const {
    return {patch.x + static_cast<float>(log_radius * x_per_radius_),
            patch.y + static_cast<float>(log_radius * y_per_radius_), patch.log_radius + static_cast<float>(log_radius),
            patch.newtons};
  }

  Patch patch;
  double step = 0.0;  // from `about`
  double variance_x = 0.0;
  double variance_y = 0.0;
  double determinant = 0.0;  // of the equations in x and y
  double chi_squared;

 private:
  double x_per_radius_ = 0.0;  // d x / d ln radius along the best places
  double y_per_radius_ = 0.0;
};

/// Sums over radii, each by the integral of its likelihood over place and force (Laplace's approximation).
class RadiusSum {
 public:
  RadiusSum(double least_chi_squared, double misfit) : least_chi_squared_(least_chi_squared), misfit_(misfit) {}

  /// Returns the weight of the radius.
  double add(const BestPlace& best) {
    const double likelihood = std::exp(0.5 * (least_chi_squared_ - best.chi_squared) / misfit_);
    const double weight = likelihood / (best.patch.newtons * std::sqrt(best.determinant));
    const double x = best.patch.x;
    const double y = best.patch.y;
    weight_ += weight;
    x_ += weight * x;
    y_ += weight * y;
    xx_ += weight * (x * x + misfit_ * best.variance_x);
    yy_ += weight * (y * y + misfit_ * best.variance_y);
    log_radius_ += weight * best.patch.log_radius;
    return weight;
  }

  void write_mean(PatchFit& fit) const {
    const double x = x_ / weight_;
    const double y = y_ / weight_;
    fit.patch.x = static_cast<float>(x);
    fit.patch.y = static_cast<float>(y);
    fit.patch.log_radius = static_cast<float>(log_radius_ / weight_);
    fit.variance_x = static_cast<float>(std::max(0.0, xx_ / weight_ - x * x));
    fit.variance_y = static_cast<float>(std::max(0.0, yy_ / weight_ - y * y));
  }

 private:
  double least_chi_squared_;
  double misfit_;
  double weight_ = 0.0;
  double x_ = 0.0;
  double y_ = 0.0;
  double xx_ = 0.0;
  double yy_ = 0.0;
  double log_radius_ = 0.0;
};

}  // namespace

PatchFit mean_over_radii(std::span<const FitTaxel> taxels, const PatchResponses& responses, const PatchFit& most_likely,
                         const PatchPrior& prior) noexcept {
  static const float kLow = std::log(PatchResponse::kLeastRadius);
  static const float kHigh = std::log(PatchResponse::kMostRadius);
  const PatchResponse& response = responses.of(most_likely.profile);
  const NormalEquations middle = normal_equations(taxels, response, most_likely.patch, prior);
  const double variance = most_likely.misfit * Factor(middle.matrix, 0.0).solve({0.0, 0.0, 1.0})[2];
  const double step = std::clamp(kRadiusStep * std::sqrt(std::max(variance, 0.0)), kLeastRadiusStep, kMostRadiusStep);
  const BestPlace most_likely_place(most_likely.patch, middle);
  RadiusSum sum(most_likely_place.chi_squared, most_likely.misfit);
  const double most = sum.add(most_likely_place);
  for (const double direction : {-step, step}) {
    BestPlace best = most_likely_place;
    for (int k = 0; k < kMostRadii; ++k) {
      const Patch expected = best.larger_by(direction);
      if (expected.log_radius < kLow || expected.log_radius > kHigh) break;
      best = BestPlace(expected, normal_equations(taxels, response, expected, prior));
      if (best.step > kSmallStep) best = BestPlace(best.patch, normal_equations(taxels, response, best.patch, prior));
      if (!(best.step < kLongestStep) || sum.add(best) < kLeastWeight * most) break;
    }
  }
  PatchFit mean = most_likely;
  sum.write_mean(mean);
  return mean;
}

PatchFit mean_of_profiles(const PatchFit& one, const PatchFit& other) noexcept {
  const PatchFit& better = one.chi_squared <= other.chi_squared ? one : other;
  const PatchFit& worse = one.chi_squared <= other.chi_squared ? other : one;
  const float odds = std::exp(0.5F * (better.chi_squared - worse.chi_squared) / better.misfit);
  const float share = odds / (1.0F + odds);  // of the worse
  const float dx = worse.patch.x - better.patch.x;
  const float dy = worse.patch.y - better.patch.y;
  PatchFit mean = better;
  mean.patch.x += share * dx;
  mean.patch.y += share * dy;
  mean.patch.log_radius += share * (worse.patch.log_radius - better.patch.log_radius);
  mean.variance_x += share * (worse.variance_x - better.variance_x + (1.0F - share) * dx * dx);
  mean.variance_y += share * (worse.variance_y - better.variance_y + (1.0F - share) * dy * dy);
  return mean;
}

}  // namespace dermis::touch::contacts
