// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/sagging_supply.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::touch::compensation {
namespace {

constexpr int kMostPasses = 40;
constexpr double kRounded = 1e-12;  // of a ratio; what is left of it is rounding

}  // namespace

SaggingSupply::SaggingSupply(std::unique_ptr<CrosstalkInversion> ideal, CircuitModel model, FilmFollower film,
                             double tolerance_ratio)
    : ideal_(std::move(ideal)),
      model_(std::move(model)),
      film_(std::move(film)),
      tolerance_(std::max(tolerance_ratio, kRounded)),
      left_(model_.ratio().size(), 1.0),
      full_ratio_(left_.size()) {
  model_.solve(std::vector<double>(left_.size()));  // the first call allocates
}

InversionResult SaggingSupply::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  InversionResult result;
  double change = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    for (std::size_t k = 0; k < ratio.size(); ++k) full_ratio_[k] = ratio[k] / left_[k];
    result = ideal_->invert(full_ratio_, siemens);
    if (!result.solved) break;
    if (film_.follow(siemens)) model_.set_film(film_.film());
    model_.solve(siemens);
    change = follow_supply(ratio);
    if (change <= tolerance_) break;
  }
  result.residual_ratio += change;
  result.solved = result.solved && change <= tolerance_;
  if (!result.solved) std::fill(left_.begin(), left_.end(), 1.0);
  return result;
}

/// By how much the largest reading of an ideal supply changes.
double SaggingSupply::follow_supply(std::span<const double> ratio) noexcept {
  double change = 0.0;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    left_[k] = model_.supply_left()[k];
    if (!std::isnan(ratio[k])) change = std::max(change, std::abs(ratio[k] / left_[k] - full_ratio_[k]));
  }
  return change;
}

void SaggingSupply::hold_film(const FilmConductances& film) noexcept {
  ideal_->hold_film(film);
  film_.hold(film);
  model_.set_film(film_.film());
}

void SaggingSupply::forget() noexcept {
  ideal_->forget();
  std::fill(left_.begin(), left_.end(), 1.0);
}

/// A taxel that takes more of the supply lowers its own reading: about once more.
void SaggingSupply::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  ideal_->propagate_noise(sigma_ratio, sigma_siemens);
  for (std::size_t k = 0; k < left_.size(); ++k) sigma_siemens[k] /= left_[k] * left_[k];
}

}  // namespace dermis::touch::compensation
