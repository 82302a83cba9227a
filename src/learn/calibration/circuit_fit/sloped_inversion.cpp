// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/sloped_inversion.hpp"

#include <utility>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSlopeStep = 1e-3;   // of a parameter
constexpr double kTolerance = 1e-12;  // of the inversions, in readings over the supply
constexpr int kMostSteps = 25;        // of a frame: circuits are tried that cannot give it

}  // namespace

std::size_t frames_per_task(const ArrayDescription& array) {
  constexpr std::size_t kMany = 256;
  constexpr std::size_t kFew = 16;  // so that no core is idle
  return is_inverted_slowly(array) ? kFew : kMany;
}

Result<SlopedInversion> SlopedInversion::create(const LineParameters& lines, const VectorXd& parameters,
                                                Slopes slopes) {
  SlopedInversion result;
  const Index count = slopes == Slopes::all ? parameters.size() : 0;
  result.slope_count_ = count;
  result.film_ = lines.array().readout.film;
  result.film_conductances_ = FilmConductances(lines.array().rows, lines.array().cols);
  const bool is_slow = is_inverted_slowly(lines.array());
  if (is_slow && count > 0) {
    Result<SolvedSlopes> solved = SolvedSlopes::create(lines, parameters);
    if (!solved) return solved.error();
    result.solved_slopes_.emplace(*std::move(solved));
  }
  touch::compensation::InversionOptions options;  // far below the noise; differences need more
  options.samples_noise = true;
  options.most_steps = kMostSteps;
  if (count > 0 && !is_slow) options.tolerance_ratio = kTolerance;
  for (Index p = -1; p < (is_slow ? 0 : count); ++p) {
    VectorXd shifted = parameters;
    if (p >= 0) shifted[p] += kSlopeStep;
    auto inversion = touch::compensation::make_crosstalk_inversion(lines.array_at(shifted), options);
    if (!inversion) return inversion.error();
    result.inversions_.push_back(std::move(*inversion));
  }
  return result;
}

void SlopedInversion::hold_film(const std::vector<float>& newtons) {
  if (!film_) return;
  film_conductances_.set(*film_, newtons);
  for (const auto& inversion : inversions_) inversion->hold_film(film_conductances_);
}

void SlopedInversion::forget() {
  for (const auto& inversion : inversions_) inversion->forget();
}

bool SlopedInversion::invert(const std::vector<double>& ratio, std::vector<double>& siemens) {
  return inversions_[0]->invert(ratio, siemens).solved;
}

void SlopedInversion::propagate_noise(double sigma_ratio, std::vector<double>& sigma) {
  inversions_[0]->propagate_noise(sigma_ratio, sigma);
}

bool SlopedInversion::differentiate(const std::vector<double>& ratio, const std::vector<double>& siemens,
                                    Eigen::MatrixXd& slopes) {
  if (solved_slopes_) {
    solved_slopes_->differentiate(siemens, slopes);
    return slopes.allFinite();
  }
  shifted_.resize(ratio.size());
  for (Index p = 0; p < slopes.cols(); ++p) {
    if (!inversions_[static_cast<std::size_t>(p) + 1]->invert(ratio, shifted_).solved) return false;
    for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
      slopes(static_cast<Index>(taxel), p) = (shifted_[taxel] - siemens[taxel]) / kSlopeStep;
    }
  }
  return true;
}

}  // namespace dermis::learn::calibration
