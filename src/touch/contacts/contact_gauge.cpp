// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/contact_gauge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "touch/contacts/area_sums.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr double kFading = 10.0;  // taxels, below the most that are fitted: from there on the centre of mass takes over

/// Null where all taxels are at an edge.
std::shared_ptr<const SmallContactTable> small_contacts(const TaxelPlane& plane) {
  if (plane.rows == 1 || plane.cols == 1) return nullptr;
  return SmallContactTable::of(
      {plane.col_pitch_m / plane.taxel_radius_m, plane.row_pitch_m / plane.taxel_radius_m, plane.cover_spread},
      *plane.responses);
}

}  // namespace

ContactGauge::ContactGauge(const TaxelPlane& plane, std::optional<StripTable> strip)
    : plane_(plane), strip_(std::move(strip)), small_contacts_(small_contacts(plane)), search_(plane) {}

Measurement ContactGauge::measure(const ForceFrame& force, std::span<const std::uint32_t> taxels, double pressed_sigma,
                                  const ExpectedContact* expected) {
  Measurement measured{sum_up(plane_, force, taxels), taxels.front(), {}};
  Contact& contact = measured.contact;
  if (strip_) {
    correct(force, taxels, contact);
    return measured;
  }
  contact.position = centre_of_mass(plane_, force, taxels, contact.position);
  if (taxels.size() > PatchSearch::kMostTaxels) return measured;
  if (const std::optional<ContactPlace> found = place(force, taxels, pressed_sigma, expected, measured)) {
    contact.position = found->position;
    contact.sigma_position_m = found->sigma;
    contact.area_m2 = std::numbers::pi * found->radius_m * found->radius_m;
  }
  return measured;
}

float ContactGauge::scatter_of_weak_taxels(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                           double pressed_sigma, const Measurement& measured) {
  search_.gather(force, taxels, pressed_sigma);
  return search_.scatter_of_weak_taxels(*measured.patch);
}

/// The centre of mass is that of the signals, each of which has a noise of one. It does not depend on the force where
/// all taxels follow one power law. Saturated taxels have no signal: the centre of the forces is used there.
void ContactGauge::correct(const ForceFrame& force, std::span<const std::uint32_t> taxels, Contact& contact) const {
  const auto along = plane_.rows == 1 ? &PlaneVector::x : &PlaneVector::y;
  double sum = 0.0;
  double moment = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double signal = force.signal_to_noise[taxel];
    sum += signal;
    moment += signal * plane_.centre(taxel).*along;
  }
  if (!std::isfinite(sum)) {
    contact.position.*along = strip_->at(contact.position.*along).position_m;
    return;
  }
  const double middle = moment / sum;
  double variance = 0.0;
  for (const std::uint32_t taxel : taxels) variance += std::pow((plane_.centre(taxel).*along - middle) / sum, 2);
  const StripTable::Place place = strip_->at(middle);
  const double sigma = std::hypot(strip_->sigma_m, place.slope * std::sqrt(variance));
  contact.position.*along = place.position_m;
  if (sigma > 0.0) contact.sigma_position_m.*along = sigma;
}

/// One or two taxels give no more than the table. On a block of three or four, the patch of about the radius that
/// presses them is taken. The table gives the deviation of other patches that fit.
std::optional<ContactPlace> ContactGauge::place(const ForceFrame& force, std::span<const std::uint32_t> taxels,
                                                double pressed_sigma, const ExpectedContact* expected,
                                                Measurement& measured) {
  const Contact& contact = measured.contact;
  const std::optional<ContactPlace> of_table = look_up(force, taxels);
  if (of_table && taxels.size() <= 2) return of_table;
  search_.gather(force, taxels, pressed_sigma);
  const bool is_expected = !of_table && expected != nullptr;
  const ExpectedContact start =
      is_expected ? *expected : ExpectedContact{contact.position, reach(taxels, contact.position), PatchProfile::hertz};
  // About half of the force lies between the taxels.
  const std::optional<FoundPatch> found = search_.find(start, 2.0 * contact.force_n);
  if (!found) return of_table;
  measured.patch = found->most_likely;
  if (!of_table) return blend(*found, contact);
  ContactPlace place = found->place;
  place.sigma = {std::hypot(of_table->sigma.x, place.position.x - of_table->position.x),
                 std::hypot(of_table->sigma.y, place.position.y - of_table->position.y)};
  return place;
}

std::optional<ContactPlace> ContactGauge::look_up(const ForceFrame& force,
                                                  std::span<const std::uint32_t> taxels) const {
  if (taxels.size() > PatchSearch::kSmall) return {};
  const std::size_t peak = taxels.front();
  const std::size_t row = peak / plane_.cols;
  const std::size_t col = peak % plane_.cols;
  if (row == 0 || col == 0 || row + 1 == plane_.rows || col + 1 == plane_.cols) return {};
  const auto newtons = [&](std::size_t r, std::size_t c) { return force.newtons[r * plane_.cols + c]; };
  const std::size_t beside = newtons(row, col + 1) >= newtons(row, col - 1) ? col + 1 : col - 1;
  const std::size_t below = newtons(row + 1, col) >= newtons(row - 1, col) ? row + 1 : row - 1;
  for (const std::uint32_t taxel : taxels) {
    const std::size_t r = taxel / plane_.cols;
    const std::size_t c = taxel % plane_.cols;
    if ((r != row && r != below) || (c != col && c != beside)) return {};
  }
  float variance = 0.0F;
  for (std::size_t r = row - 1; r <= row + 1; ++r) {
    for (std::size_t c = col - 1; c <= col + 1; ++c) {
      if (r == row && c == col) continue;
      const float sigma = force.sigma_newtons[r * plane_.cols + c];
      variance += 0.125F * sigma * sigma;
    }
  }
  if (!std::isfinite(variance) || !std::isfinite(force.sigma_newtons[peak])) return {};
  const float strongest = newtons(row, col);
  const auto place = small_contacts_->find({newtons(row, beside) / strongest, newtons(below, col) / strongest,
                                            newtons(below, beside) / strongest, std::sqrt(variance) / strongest});
  if (!place) return {};
  const double across = beside > col ? plane_.taxel_radius_m : -plane_.taxel_radius_m;
  const double down = below > row ? plane_.taxel_radius_m : -plane_.taxel_radius_m;
  const PlaneVector at = plane_.centre(peak);
  return ContactPlace{
      {at.x + across * place->x, at.y + down * place->y},
      {plane_.taxel_radius_m * std::sqrt(place->variance_x), plane_.taxel_radius_m * std::sqrt(place->variance_y)},
      plane_.taxel_radius_m * std::exp(place->log_radius)};
}

/// Radius of a patch about `place` that presses all these taxels.
double ContactGauge::reach(std::span<const std::uint32_t> taxels, PlaneVector place) const {
  double most = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double dx = plane_.centre(taxel).x - place.x;
    const double dy = plane_.centre(taxel).y - place.y;
    most = std::max(most, dx * dx + dy * dy);
  }
  return std::max(plane_.taxel_radius_m, std::sqrt(most) - 0.6 * plane_.taxel_radius_m);
}

ContactPlace ContactGauge::blend(const FoundPatch& found, const Contact& contact) const {
  const PlaneVector mass = contact.position;
  const PlaneVector sigma_mass = contact.sigma_position_m;
  const auto variance = [&](const PlaneVector& sigma) {  // along the axes that the taxels determine
    return (plane_.cols > 1 ? sigma.x * sigma.x : 0.0) + (plane_.rows > 1 ? sigma.y * sigma.y : 0.0);
  };
  const double ratio =
      found.misfit * variance(found.place.sigma) / std::max(variance(sigma_mass), std::numeric_limits<double>::min());
  const double fading = (static_cast<double>(PatchSearch::kMostTaxels + 1) - contact.taxels) / kFading;
  const double share = std::min(1.0, fading) / (1.0 + ratio * ratio);  // of the fit
  const auto place = [&](double fitted, double other) { return other + share * (fitted - other); };
  const auto sigma = [&](double fitted, double other, double apart) {
    return std::sqrt(share * fitted * fitted + (1.0 - share) * (other * other + share * apart * apart));
  };
  ContactPlace mean;
  mean.position = {place(found.place.position.x, mass.x), place(found.place.position.y, mass.y)};
  mean.sigma = {sigma(found.place.sigma.x, sigma_mass.x, found.place.position.x - mass.x),
                sigma(found.place.sigma.y, sigma_mass.y, found.place.position.y - mass.y)};
  mean.radius_m = place(found.place.radius_m, std::sqrt(contact.area_m2 / std::numbers::pi));
  return mean;
}

}  // namespace dermis::touch::contacts
