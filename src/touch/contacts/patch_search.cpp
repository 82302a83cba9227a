// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_search.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/neighbours.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr double kPriorRadiusPitches = 0.75;  // fingers and heels of hands on a pitch of 10 mm
constexpr float kPriorSigma = 0.6F;
constexpr float kMismatchOfTaxel = 0.003F;  // deviation of a real patch's shape from the model's
constexpr float kMismatchOfPeak = 0.0005F;
constexpr float kMismatchUnderCover = 0.015F;  // of a taxel: no cover is quite a Gaussian
constexpr float kPlainMisfit = 2.0F;           // chi squared per degree of freedom, up to which noise explains a misfit
constexpr float kMostShareOfOther = 0.35F;     // of a peak, that a contact without a valley before it can have

/// Strength of the prior for a place anywhere on a cell of this pitch [1/radii of a taxel^2].
double strength_on_cell(double pitch_m, double taxel_radius_m) {
  return 12.0 * std::pow(taxel_radius_m / pitch_m, 2);
}

/// [N^2]
float square_of_residual(const PatchResponses& responses, const PatchFit& fit, const FitTaxel& taxel) {
  const PatchResponse::Row response = responses.of(fit.profile).row(fit.patch.log_radius);
  const float dx = taxel.x - fit.patch.x;
  const float dy = taxel.y - fit.patch.y;
  const float distance = std::sqrt(dx * dx + dy * dy);
  const float residual =
      taxel.newtons - (distance < response.reach() ? fit.patch.newtons * response.share(distance) : 0.0F);
  return residual * residual;
}

}  // namespace

bool is_weak(float newtons, float peak_newtons) noexcept {
  return newtons < kMostShareOfOther * peak_newtons;
}

PatchSearch::PatchSearch(const TaxelPlane& plane) : plane_(plane), visited_(plane.places.size()) {
  const double pitch = std::sqrt(plane.row_pitch_m * plane.col_pitch_m);
  prior_.log_radius = static_cast<float>(std::log(kPriorRadiusPitches * pitch / plane.taxel_radius_m));
  prior_.sigma = kPriorSigma;
  if (plane.cols == 1) {
    prior_.strength_x = static_cast<float>(strength_on_cell(plane.col_pitch_m, plane.taxel_radius_m));
  }
  if (plane.rows == 1) {
    prior_.strength_y = static_cast<float>(strength_on_cell(plane.row_pitch_m, plane.taxel_radius_m));
  }
  taxels_.reserve(9 * kMostTaxels);
}

void PatchSearch::gather(const ForceFrame& force, std::span<const std::uint32_t> taxels, double pressed_sigma) {
  ++area_;
  const auto least_of_other = static_cast<float>(pressed_sigma);
  taxels_.clear();
  peak_ = taxels.front();
  peak_newtons_ = force.newtons[peak_];
  is_small_ = taxels.size() <= kSmall;
  for (const std::uint32_t taxel : taxels) {
    visited_[taxel] = area_;
    add(force, taxel);
  }
  for (const std::uint32_t taxel : taxels) {
    for (const std::size_t beside : Neighbours(plane_.rows, plane_.cols, taxel)) {
      if (visited_[beside] == area_) continue;
      visited_[beside] = area_;
      const bool is_of_other = force.signal_to_noise[beside] >= least_of_other;
      if (!is_of_other) add(force, static_cast<std::uint32_t>(beside));
    }
  }
}

void PatchSearch::add(const ForceFrame& force, std::uint32_t taxel) {
  const float newtons = force.newtons[taxel];
  const float sigma = force.sigma_newtons[taxel];
  if (!std::isfinite(newtons) || !std::isfinite(sigma)) return;
  const PlaneVector at = plane_.places[taxel];
  const PlaneVector origin = plane_.places[peak_];
  const float of_taxel = (plane_.cover_spread > 0.0 ? kMismatchUnderCover : kMismatchOfTaxel) * newtons;
  const float of_peak = kMismatchOfPeak * peak_newtons_;
  const float weight = 1.0F / std::sqrt(sigma * sigma + of_taxel * of_taxel + of_peak * of_peak);
  taxels_.push_back({static_cast<float>(at.x - origin.x), static_cast<float>(at.y - origin.y), newtons, weight});
}

std::optional<FoundPatch> PatchSearch::find(const ExpectedContact& start, double newtons) {
  const PatchProfile second = start.profile == PatchProfile::hertz ? PatchProfile::flat : PatchProfile::hertz;
  PatchFit one = fit_patch(taxels_, *plane_.responses, start.profile, start_at(start, newtons), prior_);
  PatchFit other = fit_patch(taxels_, *plane_.responses, second, one.patch, prior_);
  const PatchFit& first = one.chi_squared <= other.chi_squared ? one : other;
  const double misfit = std::max(1.0F, first.misfit / kPlainMisfit);
  if (misfit > 1.0) {
    add_mismatch(first);
    one = fit_patch(taxels_, *plane_.responses, start.profile, one.patch, prior_);
    other = fit_patch(taxels_, *plane_.responses, second, other.patch, prior_);
  }
  const PatchFit& better = one.chi_squared <= other.chi_squared ? one : other;
  const PatchFit mean =
      is_small_ ? mean_over_radii(taxels_, *plane_.responses, better, prior_) : mean_of_profiles(one, other);
  const double radius_m = plane_.taxel_radius_m;
  const PlaneVector sigma{radius_m * std::sqrt(mean.variance_x), radius_m * std::sqrt(mean.variance_y)};
  if (!(sigma.x > 0.0 && sigma.x < plane_.col_pitch_m && sigma.y > 0.0 && sigma.y < plane_.row_pitch_m)) return {};
  const PlaneVector origin = plane_.centre(peak_);
  const PlaneVector position{origin.x + radius_m * mean.patch.x, origin.y + radius_m * mean.patch.y};
  return FoundPatch{better, {position, sigma, radius_m * std::exp(mean.patch.log_radius)}, misfit};
}

Patch PatchSearch::start_at(const ExpectedContact& start, double newtons) const {
  const PlaneVector origin = plane_.centre(peak_);
  Patch patch;
  patch.x = static_cast<float>((start.place.x - origin.x) / plane_.taxel_radius_m);
  patch.y = static_cast<float>((start.place.y - origin.y) / plane_.taxel_radius_m);
  patch.log_radius = static_cast<float>(std::log(start.radius_m / plane_.taxel_radius_m));
  patch.newtons = static_cast<float>(newtons);
  return patch;
}

/// Where the residual of the patch exceeds the noise, the material is uneven, or the patch not round. Then every taxel
/// has a deviation beside its noise. Otherwise the taxels of the least noise, at the rim, would place it alone.
void PatchSearch::add_mismatch(const PatchFit& fit) {
  float squares = 0.0F;
  for (const FitTaxel& taxel : taxels_) squares += square_of_residual(*plane_.responses, fit, taxel);
  const float variance = (1.0F - kPlainMisfit / fit.misfit) * squares / static_cast<float>(taxels_.size());
  for (FitTaxel& taxel : taxels_) taxel.weight /= std::sqrt(1.0F + variance * taxel.weight * taxel.weight);
}

float PatchSearch::scatter_of_weak_taxels(const PatchFit& patch) const {
  float squares = 0.0F;
  float count = 0.0F;
  for (const FitTaxel& taxel : taxels_) {
    if (!is_weak(taxel.newtons, peak_newtons_)) continue;
    squares += square_of_residual(*plane_.responses, patch, taxel);
    count += 1.0F;
  }
  return std::sqrt(squares / std::max(count, 1.0F));
}

}  // namespace dermis::touch::contacts
