// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/uncertainty/relative_sigma_fit.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kOneSigmaShare = 0.682689;  // of a normal distribution within one standard deviation
constexpr double kTwoSigmaShare = 0.954500;  // within two
constexpr double kOutlierRatio = 9.0;        // of mean squares: three standard deviations
constexpr double kLeastRelativeSigma = 1e-3;
constexpr double kStartRelativeSigma = 0.1;
constexpr std::size_t kLoadsPerKnot = 50;
constexpr double kPriorShare = 0.1;  // of the loads: as many more say that all forces are alike

using Square = double JudgedLoad::*;

/// Whether more loads are outside their intervals than in a normal distribution. One and two standard deviations count
/// together, since the errors of a material with memory have longer tails.
bool is_too_sure(const std::vector<double>& square_scores) {
  const double one = quantile(square_scores, kOneSigmaShare);
  const double two = quantile(square_scores, kTwoSigmaShare) / 4.0;
  return one * two > 1.0;
}

/// The multiple of `profile` with which the standard deviations are right; bisection in its logarithm.
VarianceProfile scaled(const VarianceProfile& profile, const std::vector<JudgedLoad>& loads, Square square,
                       double supply_noise) {
  double low = 1e-4;
  double high = 1e4;
  VarianceProfile result = profile;
  std::vector<double> scores(loads.size());
  constexpr int kSteps = 24;
  for (int step = 0; step < kSteps; ++step) {
    const double scale = std::sqrt(low * high);
    std::transform(profile.begin(), profile.end(), result.begin(), [&](double variance) {
      return std::max(scale * variance, kLeastRelativeSigma * kLeastRelativeSigma);
    });
    for (std::size_t k = 0; k < loads.size(); ++k)
      scores[k] = loads[k].*square / loads[k].variance(supply_noise, result);
    (is_too_sure(scores) ? low : high) = scale;
  }
  return result;
}

/// The same relative error at all forces.
VarianceProfile even_profile(const std::vector<JudgedLoad>& loads, Square square, double supply_noise) {
  VarianceProfile start;
  start.fill(kStartRelativeSigma * kStartRelativeSigma);
  return scaled(start, loads, square, supply_noise);
}

}  // namespace

double surprise(const std::vector<JudgedLoad>& loads, double supply_noise) {
  if (loads.empty()) return 0.0;
  const VarianceProfile profile = even_profile(loads, &JudgedLoad::square_noise, supply_noise);
  double sum = 0.0;
  for (const JudgedLoad& load : loads) {
    const double variance = load.variance(supply_noise, profile);
    sum += 0.5 * (std::log(variance) + std::min(load.square_noise / variance, kOutlierRatio));
  }
  return sum;
}

/// The fixed point of the variance components of a normal distribution (the multiplicative step of Lange's MM
/// algorithm), outliers as above. Loads that nobody put on stand at each knot for the mean of all loads. So a knot
/// without loads of its own leans on the others.
VarianceProfile likeliest_profile(const std::vector<JudgedLoad>& loads, double supply_noise) {
  const VarianceProfile even = even_profile(loads, &JudgedLoad::square_error, supply_noise);
  VarianceProfile profile = even;
  const double prior = kPriorShare * static_cast<double>(loads.size()) / static_cast<double>(profile.size());
  if (loads.size() < kLoadsPerKnot * profile.size()) return profile;
  constexpr int kSteps = 100;
  for (int step = 0; step < kSteps; ++step) {
    VarianceProfile found{};
    VarianceProfile expected{};
    for (const JudgedLoad& load : loads) {
      const double variance = load.variance(supply_noise, profile);
      const double score = std::min(load.square_error / variance, kOutlierRatio);
      for (std::size_t k = 0; k < profile.size(); ++k) {
        found[k] += load.material[k] / variance * score;
        expected[k] += load.material[k] / variance;
      }
    }
    for (std::size_t k = 0; k < profile.size(); ++k) {
      found[k] += prior / profile[k] * even[k] / profile[k];
      expected[k] += prior / profile[k];
      profile[k] *= std::sqrt(found[k] / expected[k]);
    }
  }
  return scaled(profile, loads, &JudgedLoad::square_error, supply_noise);
}

}  // namespace dermis::learn::calibration
