// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fusion/contact_gauge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dermis/core/neighbours.hpp"
#include "fusion/strip.hpp"

namespace dermis::fusion {
namespace {

constexpr std::size_t kSmall = 4;             // pressed taxels, of which patches of many sizes press as many
constexpr std::size_t kMostFitted = 40;       // pressed taxels; of more the centre of mass is as good,
constexpr double kFading = 10.0;              // and from so many less on it takes over
constexpr double kPriorRadiusPitches = 0.75;  // fingers and heels of hands on a pitch of 10 mm
constexpr float kPriorSigma = 0.6F;
constexpr float kMismatchOfTaxel = 0.003F;  // what the shape of a real patch differs by from the model's
constexpr float kMismatchOfPeak = 0.0005F;
constexpr float kPlainMisfit = 2.0F;        // chi squared per degree of freedom, up to which noise explains a misfit
constexpr float kMostShareOfOther = 0.35F;  // of a peak, that a contact without a valley before it can have
constexpr double kLeastPitchesApart = 1.6;  // from this contact's centre to the strongest taxel of another
constexpr float kLeastShareOfOther = 0.5F;  // of a taxel's force, that is not this contact's

double taxel_area(const ArrayDescription& array) {
  const double diameter = 0.7 * std::min(array.row_pitch_m, array.col_pitch_m);
  return array.taxel_area_m2.value_or(std::numbers::pi / 4.0 * diameter * diameter);
}

/// All taxels are at an edge.
bool is_narrow(const ArrayDescription& array) {
  return array.rows == 1 || array.cols == 1;
}

/// Of a disc of the same area; on a strip, whose taxels may be long across it, no larger than fits in the pitch along
/// it.
double taxel_radius(const ArrayDescription& array) {
  const double radius = std::sqrt(taxel_area(array) / std::numbers::pi);
  const std::optional<double> pitch = strip_pitch_m(array);
  return pitch ? std::min(radius, 0.5 * *pitch) : radius;
}

/// Of a place anywhere on a cell of this pitch [1/radii of a taxel^2].
double strength_on_cell(double pitch_m, double taxel_radius_m) {
  return 12.0 * std::pow(taxel_radius_m / pitch_m, 2);
}

/// [N^2]
float square_of_residual(const PatchFit& fit, const FitTaxel& taxel) {
  const PatchResponse::Row response = PatchResponse::of(fit.profile).row(fit.patch.log_radius);
  const float dx = taxel.x - fit.patch.x;
  const float dy = taxel.y - fit.patch.y;
  const float distance = std::sqrt(dx * dx + dy * dy);
  const float residual =
      taxel.newtons - (distance < response.reach() ? fit.patch.newtons * response.share(distance) : 0.0F);
  return residual * residual;
}

}  // namespace

ContactGauge::ContactGauge(const ArrayDescription& array, std::optional<StripTable> strip)
    : rows_(array.rows),
      cols_(array.cols),
      row_pitch_m_(array.row_pitch_m),
      col_pitch_m_(array.col_pitch_m),
      taxel_area_m2_(taxel_area(array)),
      taxel_radius_m_(taxel_radius(array)),
      strip_(std::move(strip)),
      small_contacts_(is_narrow(array) ? nullptr
                                       : SmallContactTable::of({array.col_pitch_m / taxel_radius_m_,
                                                                array.row_pitch_m / taxel_radius_m_})),
      visited_(array.taxel_count()) {
  const double pitch = std::sqrt(row_pitch_m_ * col_pitch_m_);
  prior_.log_radius = static_cast<float>(std::log(kPriorRadiusPitches * pitch / taxel_radius_m_));
  prior_.sigma = kPriorSigma;
  if (cols_ == 1) prior_.strength_x = static_cast<float>(strength_on_cell(col_pitch_m_, taxel_radius_m_));
  if (rows_ == 1) prior_.strength_y = static_cast<float>(strength_on_cell(row_pitch_m_, taxel_radius_m_));
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    places_.push_back({centre(taxel).x / taxel_radius_m_, centre(taxel).y / taxel_radius_m_});
  }
  fit_taxels_.reserve(9 * kMostFitted);
  unexplained_.reserve(kMostFitted);
  apart_.reserve(kMostFitted);
  PatchResponse::of(PatchProfile::hertz);
}

Contact ContactGauge::measure(const ForceFrame& force, std::span<const std::uint32_t> taxels, double pressed_sigma,
                              const ExpectedContact* expected) {
  Contact contact;
  fit_.reset();
  pressed_sigma_ = static_cast<float>(pressed_sigma);
  sum_forces(force, taxels, contact);
  find_moments(force, taxels, contact);
  if (strip_) {
    correct(force, taxels, contact);
    return contact;
  }
  contact.position = centre_of_mass(force, taxels, contact.position);
  if (const std::optional<Place> found = place(force, taxels, contact, expected)) {
    contact.position = found->position;
    contact.sigma_position_m = found->sigma;
    contact.area_m2 = std::numbers::pi * found->radius_m * found->radius_m;
  }
  return contact;
}

/// The centre of mass is that of the signals, each of which has a noise of one: where all taxels follow one power law,
/// it does not depend on the force. Saturated taxels have no signal: there it is that of the forces.
void ContactGauge::correct(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const {
  const auto along = rows_ == 1 ? &PlaneVector::x : &PlaneVector::y;
  double sum = 0.0;
  double moment = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double signal = force.signal_to_noise[taxel];
    sum += signal;
    moment += signal * centre(taxel).*along;
  }
  if (!std::isfinite(sum)) {
    contact.position.*along = strip_->at(contact.position.*along).position_m;
    return;
  }
  const double middle = moment / sum;
  double variance = 0.0;
  for (const std::uint32_t taxel : taxels) variance += std::pow((centre(taxel).*along - middle) / sum, 2);
  const StripTable::Place place = strip_->at(middle);
  const double sigma = std::hypot(strip_->sigma_m, place.slope * std::sqrt(variance));
  contact.position.*along = place.position_m;
  if (sigma > 0.0) contact.sigma_position_m.*along = sigma;
}

/// One or two taxels tell no more than the table. On a block of three or four, the patch of about the radius that
/// presses them is taken, and the table tells how far off others that fit may be.
std::optional<ContactGauge::Place> ContactGauge::place(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                                       const Contact& contact, const ExpectedContact* expected) {
  if (taxels.size() > kMostFitted) return {};
  const std::optional<Place> of_table = look_up(force, taxels);
  if (of_table && taxels.size() <= 2) return of_table;
  gather(force, taxels);
  const double newtons = 2.0 * contact.force_n;  // about half of the force lies between the taxels
  if (!of_table) {
    const std::optional<Place> of_fit =
        expected != nullptr
            ? fit(taxels, start_at(expected->place, expected->radius_m, newtons), expected->profile)
            : fit(taxels, start_at(contact.position, reach(taxels, contact.position), newtons), PatchProfile::hertz);
    return of_fit ? blend(*of_fit, contact) : of_fit;
  }
  const Patch start = start_at(contact.position, reach(taxels, contact.position), newtons);
  std::optional<Place> of_fit = fit(taxels, start, PatchProfile::hertz);
  if (!of_fit) return of_table;
  of_fit->sigma = {std::hypot(of_table->sigma.x, of_fit->position.x - of_table->position.x),
                   std::hypot(of_table->sigma.y, of_fit->position.y - of_table->position.y)};
  return of_fit;
}

void ContactGauge::sum_forces(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const {
  double variance = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double newtons = force.newtons[taxel];
    const double sigma = force.sigma_newtons[taxel];
    contact.force_n += newtons;
    variance += sigma * sigma;
    contact.position.x += newtons * centre(taxel).x;
    contact.position.y += newtons * centre(taxel).y;
  }
  const auto count = static_cast<double>(taxels.size());
  contact.position.x /= contact.force_n;
  contact.position.y /= contact.force_n;
  contact.sigma_position_m = {0.2 * col_pitch_m_ / std::sqrt(count), 0.2 * row_pitch_m_ / std::sqrt(count)};
  contact.sigma_force_n = std::sqrt(variance);
  contact.area_m2 = count * row_pitch_m_ * col_pitch_m_;
  contact.peak_pressure_pa = force.newtons[taxels.front()] / taxel_area_m2_;
  contact.mean_pressure_pa = contact.force_n / (count * taxel_area_m2_);
  contact.taxels = static_cast<std::uint32_t>(taxels.size());
}

void ContactGauge::find_moments(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                Contact& contact) const {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double share = force.newtons[taxel] / contact.force_n;
    const PlaneVector place = centre(taxel);
    const double x = place.x - contact.position.x;
    const double y = place.y - contact.position.y;
    xx += share * x * x;
    xy += share * x * y;
    yy += share * y * y;
  }
  const double half = 0.5 * std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
  const double middle = 0.5 * (xx + yy);
  contact.major_axis_m = std::sqrt(middle + half);
  contact.minor_axis_m = std::sqrt(std::max(0.0, middle - half));
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  contact.angle_rad = angle <= -std::numbers::pi / 2.0 ? std::numbers::pi / 2.0 : angle;
}

/// Each taxel weighs the root of its force times its signal. Of the forces alone, one that hardly stands out of the
/// noise at the rim weighs what its law makes of that noise, which comes and goes; of the signals alone, what unlike
/// taxels differ by. Saturated taxels have no signal: there it is that of the forces.
PlaneVector ContactGauge::centre_of_mass(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                         PlaneVector of_forces) const {
  double sum = 0.0;
  PlaneVector first;
  for (const std::uint32_t taxel : taxels) {
    const double weight = std::sqrt(force.newtons[taxel] * force.signal_to_noise[taxel]);
    sum += weight;
    first.x += weight * centre(taxel).x;
    first.y += weight * centre(taxel).y;
  }
  if (!std::isfinite(sum)) return of_forces;
  return {first.x / sum, first.y / sum};
}

std::optional<ContactGauge::Place> ContactGauge::look_up(const ForceFrame& force,
                                                         std::span<const std::uint32_t> taxels) const {
  if (taxels.size() > kSmall) return {};
  const std::size_t peak = taxels.front();
  const std::size_t row = peak / cols_;
  const std::size_t col = peak % cols_;
  if (row == 0 || col == 0 || row + 1 == rows_ || col + 1 == cols_) return {};
  const auto newtons = [&](std::size_t r, std::size_t c) { return force.newtons[r * cols_ + c]; };
  const std::size_t beside = newtons(row, col + 1) >= newtons(row, col - 1) ? col + 1 : col - 1;
  const std::size_t below = newtons(row + 1, col) >= newtons(row - 1, col) ? row + 1 : row - 1;
  for (const std::uint32_t taxel : taxels) {
    const std::size_t r = taxel / cols_;
    const std::size_t c = taxel % cols_;
    if ((r != row && r != below) || (c != col && c != beside)) return {};
  }
  float variance = 0.0F;
  for (std::size_t r = row - 1; r <= row + 1; ++r) {
    for (std::size_t c = col - 1; c <= col + 1; ++c) {
      if (r == row && c == col) continue;
      const float sigma = force.sigma_newtons[r * cols_ + c];
      variance += 0.125F * sigma * sigma;
    }
  }
  if (!std::isfinite(variance) || !std::isfinite(force.sigma_newtons[peak])) return {};
  const float strongest = newtons(row, col);
  const auto place = small_contacts_->find({newtons(row, beside) / strongest, newtons(below, col) / strongest,
                                            newtons(below, beside) / strongest, std::sqrt(variance) / strongest});
  if (!place) return {};
  const double across = beside > col ? taxel_radius_m_ : -taxel_radius_m_;
  const double down = below > row ? taxel_radius_m_ : -taxel_radius_m_;
  const PlaneVector at = centre(peak);
  return Place{{at.x + across * place->x, at.y + down * place->y},
               {taxel_radius_m_ * std::sqrt(place->variance_x), taxel_radius_m_ * std::sqrt(place->variance_y)},
               taxel_radius_m_ * std::exp(place->log_radius)};
}

void ContactGauge::gather(const ForceFrame& force, std::span<const std::uint32_t> taxels) {
  ++area_;
  fit_taxels_.clear();
  origin_taxel_ = taxels.front();
  origin_ = centre(origin_taxel_);
  peak_newtons_ = force.newtons[taxels.front()];
  for (const std::uint32_t taxel : taxels) {
    visited_[taxel] = area_;
    add_taxel(force, taxel);
  }
  for (const std::uint32_t taxel : taxels) {
    for (const std::size_t beside : Neighbours(rows_, cols_, taxel)) {
      if (visited_[beside] == area_) continue;
      visited_[beside] = area_;
      const bool is_of_other = force.signal_to_noise[beside] >= pressed_sigma_;
      if (!is_of_other) add_taxel(force, static_cast<std::uint32_t>(beside));
    }
  }
}

void ContactGauge::add_taxel(const ForceFrame& force, std::uint32_t taxel) {
  const float newtons = force.newtons[taxel];
  const float sigma = force.sigma_newtons[taxel];
  if (!std::isfinite(newtons) || !std::isfinite(sigma)) return;
  const PlaneVector at = places_[taxel];
  const PlaneVector origin = places_[origin_taxel_];
  const float of_taxel = kMismatchOfTaxel * newtons;
  const float of_peak = kMismatchOfPeak * peak_newtons_;
  const float weight = 1.0F / std::sqrt(sigma * sigma + of_taxel * of_taxel + of_peak * of_peak);
  fit_taxels_.push_back({static_cast<float>(at.x - origin.x), static_cast<float>(at.y - origin.y), newtons, weight});
}

std::size_t ContactGauge::part(const ForceFrame& force, std::span<std::uint32_t> taxels, double onset_sigma,
                               double share, std::span<const std::uint32_t> held) {
  if (!fit_) return taxels.size();
  unexplained_.clear();
  for (const std::uint32_t taxel : taxels) {
    if (stands_out(force, taxel, onset_sigma, share, 0.0F)) unexplained_.push_back(taxel);
  }
  const auto seed = held.empty()
                        ? unexplained_.begin()
                        : std::find_first_of(unexplained_.begin(), unexplained_.end(), held.begin(), held.end());
  if (seed == unexplained_.end()) return taxels.size();
  std::iter_swap(unexplained_.begin(), seed);
  keep_what_hangs_together(unexplained_);
  apart_.clear();
  std::size_t explained = 0;
  for (const std::uint32_t taxel : taxels) {
    if (std::find(unexplained_.begin(), unexplained_.end(), taxel) == unexplained_.end()) {
      taxels[explained++] = taxel;
    } else {
      apart_.push_back(taxel);
    }
  }
  std::copy(apart_.begin(), apart_.end(), taxels.begin() + static_cast<std::ptrdiff_t>(explained));
  return explained;
}

/// With the first of them.
void ContactGauge::keep_what_hangs_together(std::vector<std::uint32_t>& taxels) const {
  std::size_t kept = 1;
  for (std::size_t k = 0; k < kept; ++k) {
    for (std::size_t other = kept; other < taxels.size(); ++other) {
      if (are_neighbours(taxels[k], taxels[other])) std::swap(taxels[kept++], taxels[other]);
    }
  }
  taxels.resize(kept);
}

bool ContactGauge::are_neighbours(std::size_t a, std::size_t b) const noexcept {
  const std::size_t rows = std::max(a / cols_, b / cols_) - std::min(a / cols_, b / cols_);
  const std::size_t cols = std::max(a % cols_, b % cols_) - std::min(a % cols_, b % cols_);
  return rows <= 1 && cols <= 1;
}

bool ContactGauge::stands_out(const ForceFrame& force, std::uint32_t taxel, double onset_sigma, double share) const {
  return !fit_ || stands_out(force, taxel, onset_sigma, share, scatter_of_weak_taxels());
}

/// What another contact presses is weak against this one's peak, or there would be a valley.
bool ContactGauge::stands_out(const ForceFrame& force, std::uint32_t taxel, double onset_sigma, double share,
                              float scatter) const {
  const float newtons = force.newtons[taxel];
  const float sigma = std::hypot(force.sigma_newtons[taxel], scatter);
  if (!is_weak(newtons) || !std::isfinite(sigma)) return false;
  const double dx = places_[taxel].x - places_[origin_taxel_].x - fit_->patch.x;
  const double dy = places_[taxel].y - places_[origin_taxel_].y - fit_->patch.y;
  const double distance = std::sqrt(dx * dx + dy * dy);
  if (taxel_radius_m_ * distance < share * kLeastPitchesApart * std::min(row_pitch_m_, col_pitch_m_)) return false;
  const PatchResponse::Row response = PatchResponse::of(fit_->profile).row(fit_->patch.log_radius);
  const float expected = fit_->patch.newtons * response.share(static_cast<float>(distance));
  return newtons - expected >= share * std::max<double>(kLeastShareOfOther * newtons, onset_sigma * sigma);
}

bool ContactGauge::is_weak(float newtons) const noexcept {
  return newtons < kMostShareOfOther * peak_newtons_;
}

float ContactGauge::scatter_of_weak_taxels() const {
  float squares = 0.0F;
  float count = 0.0F;
  for (const FitTaxel& taxel : fit_taxels_) {
    if (!is_weak(taxel.newtons)) continue;
    squares += square_of_residual(*fit_, taxel);
    count += 1.0F;
  }
  return std::sqrt(squares / std::max(count, 1.0F));
}

Patch ContactGauge::start_at(PlaneVector place, double radius_m, double newtons) const {
  Patch start;
  start.x = static_cast<float>((place.x - origin_.x) / taxel_radius_m_);
  start.y = static_cast<float>((place.y - origin_.y) / taxel_radius_m_);
  start.log_radius = static_cast<float>(std::log(radius_m / taxel_radius_m_));
  start.newtons = static_cast<float>(newtons);
  return start;
}

/// Radius of a patch about `place` that presses all these taxels.
double ContactGauge::reach(std::span<const std::uint32_t> taxels, PlaneVector place) const {
  double most = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double dx = centre(taxel).x - place.x;
    const double dy = centre(taxel).y - place.y;
    most = std::max(most, dx * dx + dy * dy);
  }
  return std::max(taxel_radius_m_, std::sqrt(most) - 0.6 * taxel_radius_m_);
}

ContactGauge::Place ContactGauge::blend(const Place& of_fit, const Contact& contact) const {
  const PlaneVector mass = contact.position;
  const PlaneVector sigma_mass = contact.sigma_position_m;
  const auto variance = [&](const PlaneVector& sigma) {  // along the axes that the taxels tell
    return (cols_ > 1 ? sigma.x * sigma.x : 0.0) + (rows_ > 1 ? sigma.y * sigma.y : 0.0);
  };
  const double ratio =
      misfit_ * variance(of_fit.sigma) / std::max(variance(sigma_mass), std::numeric_limits<double>::min());
  const double fading = (static_cast<double>(kMostFitted + 1) - contact.taxels) / kFading;
  const double share = std::min(1.0, fading) / (1.0 + ratio * ratio);  // of the fit
  const auto place = [&](double fitted, double other) { return other + share * (fitted - other); };
  const auto sigma = [&](double fitted, double other, double apart) {
    return std::sqrt(share * fitted * fitted + (1.0 - share) * (other * other + share * apart * apart));
  };
  Place mean;
  mean.position = {place(of_fit.position.x, mass.x), place(of_fit.position.y, mass.y)};
  mean.sigma = {sigma(of_fit.sigma.x, sigma_mass.x, of_fit.position.x - mass.x),
                sigma(of_fit.sigma.y, sigma_mass.y, of_fit.position.y - mass.y)};
  mean.radius_m = place(of_fit.radius_m, std::sqrt(contact.area_m2 / std::numbers::pi));
  return mean;
}

/// Where the patch leaves more than noise explains, every taxel differs by something beside its noise: the material is
/// uneven, or the patch not round. Else the taxels of the least noise, at the rim, would place it alone.
void ContactGauge::add_mismatch(const PatchFit& fit) {
  float squares = 0.0F;
  for (const FitTaxel& taxel : fit_taxels_) squares += square_of_residual(fit, taxel);
  const float variance = (1.0F - kPlainMisfit / fit.misfit) * squares / static_cast<float>(fit_taxels_.size());
  for (FitTaxel& taxel : fit_taxels_) taxel.weight /= std::sqrt(1.0F + variance * taxel.weight * taxel.weight);
}

std::optional<ContactGauge::Place> ContactGauge::fit(std::span<const std::uint32_t> taxels, const Patch& start,
                                                     PatchProfile profile) {
  const PatchProfile second = profile == PatchProfile::hertz ? PatchProfile::flat : PatchProfile::hertz;
  PatchFit one = fit_patch(fit_taxels_, profile, start, prior_);
  PatchFit other = fit_patch(fit_taxels_, second, one.patch, prior_);
  const PatchFit& first = one.chi_squared <= other.chi_squared ? one : other;
  misfit_ = std::max(1.0F, first.misfit / kPlainMisfit);
  if (misfit_ > 1.0) {
    add_mismatch(first);
    one = fit_patch(fit_taxels_, profile, one.patch, prior_);
    other = fit_patch(fit_taxels_, second, other.patch, prior_);
  }
  const PatchFit& better = one.chi_squared <= other.chi_squared ? one : other;
  const PatchFit mean =
      taxels.size() <= kSmall ? mean_over_radii(fit_taxels_, better, prior_) : mean_of_profiles(one, other);
  const PlaneVector sigma{taxel_radius_m_ * std::sqrt(mean.variance_x), taxel_radius_m_ * std::sqrt(mean.variance_y)};
  if (!(sigma.x > 0.0 && sigma.x < col_pitch_m_ && sigma.y > 0.0 && sigma.y < row_pitch_m_)) return {};
  fit_ = better;
  return Place{{origin_.x + taxel_radius_m_ * mean.patch.x, origin_.y + taxel_radius_m_ * mean.patch.y},
               sigma,
               taxel_radius_m_ * std::exp(mean.patch.log_radius)};
}

}  // namespace dermis::fusion
