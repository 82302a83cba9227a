// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/threats/measure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dermis::live::threats {
namespace {

constexpr float kPressedSigmas = 3.0F;  // of the additive noise: a taxel that stands out less is not pressed
constexpr double kSharpShare = 0.9;     // of a contact's force, on two taxels

/// The sigma with which the force surely exceeds value - 2 sigma. Infinite: the value is a lower bound itself. Beyond
/// the calibrated range sigma is that of a logarithm.
double sigma_of_bound(double value, double sigma, bool is_beyond_range) {
  if (!std::isfinite(sigma)) return 0.0;
  if (!is_beyond_range || !(value > 0.0)) return sigma;
  const double least = value * std::exp(-kThreatSigmas * sigma / value);
  return (value - least) / kThreatSigmas;
}

double sigma_of_taxel(const ForceFrame& force, std::size_t taxel) {
  return sigma_of_bound(static_cast<double>(force.newtons[taxel]), static_cast<double>(force.sigma_newtons[taxel]),
                        force.taxels[taxel] == TaxelStatus::above_range);
}

/// Saturated, or beyond the calibrated range.
bool is_bound(const ForceFrame& force, std::size_t taxel) {
  return force.taxels[taxel] == TaxelStatus::above_range || std::isinf(force.sigma_newtons[taxel]);
}

bool is_worse(const ThreatValue& value, const ThreatValue& than) {
  return than.value == 0.0 || value.least() > than.least();
}

template <typename Visit>
void for_each_taxel(const Area& area, Visit visit) {
  for (std::size_t row = area.first_row; row <= area.last_row; ++row) {
    for (std::size_t col = area.first_col; col <= area.last_col; ++col) visit(row, col, row * area.cols + col);
  }
}

ThreatValue taxel_force(const Area& area, const ForceFrame& force) {
  ThreatValue worst;
  for_each_taxel(area, [&](std::size_t row, std::size_t col, std::size_t taxel) {
    const auto newtons = static_cast<double>(force.newtons[taxel]);
    if (!std::isfinite(newtons)) return;
    const ThreatValue value{newtons, sigma_of_taxel(force, taxel), area.place_of(row, col), 0};
    if (is_worse(value, worst)) worst = value;
  });
  return worst;
}

/// The held contact in the area with the largest `value_of`.
template <typename ValueOf>
ThreatValue worst_contact(const Area& area, const ContactReport& report, ValueOf value_of) {
  ThreatValue worst;
  for (const Contact& contact : report.contacts) {
    if (contact.phase == ContactPhase::release || !area.contains(contact.position)) continue;
    ThreatValue value = value_of(contact);
    value.position = contact.position;
    value.contact = contact.id;
    if (is_worse(value, worst)) worst = value;
  }
  return worst;
}

/// `is_beyond_range`: a taxel of the frame is, perhaps one of the contact.
ThreatValue force_of(const Contact& contact, bool is_beyond_range) {
  return {contact.force_n, sigma_of_bound(contact.force_n, contact.sigma_force_n, is_beyond_range)};
}

ThreatValue mean_pressure_of(const Contact& contact, bool is_beyond_range) {
  const ThreatValue force = force_of(contact, is_beyond_range);
  const double per_newton = force.value > 0.0 ? contact.mean_pressure_pa / force.value : 0.0;
  return {contact.mean_pressure_pa, force.sigma * per_newton};
}

ThreatValue pressure(const ThreatValue& force, const Area& area) {
  ThreatValue value = force;
  value.value /= area.taxel_area_m2;
  value.sigma /= area.taxel_area_m2;
  return value;
}

/// The hardest taxel of a contact, where it and the next hardest of the eight around it carry the contact.
ThreatValue sharp_pressure(const ThreatLimit& limit, const Area& area, const Contact& contact,
                           const ForceFrame& force) {
  if (force_of(contact, has(force.status, FrameStatus::above_range)).least() < limit.least_force_n) return {};
  Area around = area;
  const auto row = static_cast<std::size_t>(std::max(std::lround(contact.position.y / area.row_pitch_m), 0L));
  const auto col = static_cast<std::size_t>(std::max(std::lround(contact.position.x / area.col_pitch_m), 0L));
  around.first_row = row - std::min<std::size_t>(row, 1);
  around.first_col = col - std::min<std::size_t>(col, 1);
  around.last_row = std::min(area.rows - 1, row + 1);
  around.last_col = std::min(area.cols - 1, col + 1);
  ThreatValue hardest;
  double second = 0.0;
  for_each_taxel(around, [&](std::size_t, std::size_t, std::size_t taxel) {
    const auto newtons = static_cast<double>(force.newtons[taxel]);
    if (!(newtons > second)) return;
    second = std::min(newtons, hardest.value);
    if (newtons <= hardest.value) return;
    hardest = {newtons, sigma_of_taxel(force, taxel)};
  });
  return hardest.value + second >= kSharpShare * contact.force_n ? pressure(hardest, area) : ThreatValue{};
}

/// On pressed taxels alone, so that a rate has little noise.
ThreatValue pressed_force(const Area& area, const ForceFrame& force) {
  ThreatValue total;
  double variance = 0.0;
  for_each_taxel(area, [&](std::size_t row, std::size_t col, std::size_t taxel) {
    const auto newtons = static_cast<double>(force.newtons[taxel]);
    if (!(force.signal_to_noise[taxel] > kPressedSigmas) || !std::isfinite(newtons)) return;
    const double sigma = sigma_of_taxel(force, taxel);
    const PlaneVector place = area.place_of(row, col);
    total.value += newtons;
    total.position.x += newtons * place.x;
    total.position.y += newtons * place.y;
    variance += sigma * sigma;
  });
  total.sigma = std::sqrt(variance);
  if (total.value > 0.0) {
    total.position.x /= total.value;
    total.position.y /= total.value;
  }
  return total;
}

}  // namespace

Area Area::whole(const ArrayDescription& array) {
  return {.rows = array.rows,
          .cols = array.cols,
          .row_pitch_m = array.row_pitch_m,
          .col_pitch_m = array.col_pitch_m,
          .taxel_area_m2 = array.taxel_area_m2.value_or(0.0),
          .last_row = array.rows - 1,
          .last_col = array.cols - 1};
}

bool Area::contains(const PlaneVector& position) const noexcept {
  const auto is_between = [](double place, std::size_t first, std::size_t last, std::size_t lines) {
    return (first == 0 || place >= static_cast<double>(first) - 0.5) &&
           (last + 1 == lines || place < static_cast<double>(last) + 0.5);
  };
  return is_between(position.y / row_pitch_m, first_row, last_row, rows) &&
         is_between(position.x / col_pitch_m, first_col, last_col, cols);
}

PlaneVector Area::place_of(std::size_t row, std::size_t col) const noexcept {
  return {static_cast<double>(col) * col_pitch_m, static_cast<double>(row) * row_pitch_m};
}

/// Signed, so that noise cancels and weak forces on many taxels add up; taxels whose force is a bound count alone.
ThreatValue total_force(const Area& area, const ForceFrame& force) noexcept {
  thread_local std::vector<std::size_t> taxels;
  taxels.clear();
  double newtons = 0.0;
  double variance = 0.0;
  for_each_taxel(area, [&](std::size_t, std::size_t, std::size_t taxel) {
    if (!is_bound(force, taxel)) return taxels.push_back(taxel);
    newtons += static_cast<double>(force.newtons[taxel]);
    variance += std::pow(sigma_of_taxel(force, taxel), 2);
  });
  const TotalForce others = force.total(taxels);
  if (others.left_out < taxels.size()) {
    newtons += others.newtons;
    variance += std::pow(others.sigma_newtons, 2);
  }
  return {std::max(newtons, 0.0), std::sqrt(variance), pressed_force(area, force).position};
}

ThreatValue measure(const ThreatLimit& limit, const Area& area, const ForceFrame& force,
                    const ContactReport& report) noexcept {
  const bool is_beyond_range = has(force.status, FrameStatus::above_range);
  const auto worst = [&](auto value_of) { return worst_contact(area, report, value_of); };
  switch (limit.quantity) {
    case ThreatQuantity::total_force: break;
    case ThreatQuantity::force_rate: return pressed_force(area, force);
    case ThreatQuantity::taxel_force: return taxel_force(area, force);
    case ThreatQuantity::taxel_pressure: return pressure(taxel_force(area, force), area);
    case ThreatQuantity::contact_force:
      return worst([&](const Contact& contact) { return force_of(contact, is_beyond_range); });
    case ThreatQuantity::contact_pressure:
      return worst([&](const Contact& contact) { return mean_pressure_of(contact, is_beyond_range); });
    case ThreatQuantity::sharp_pressure:
      return worst([&](const Contact& contact) { return sharp_pressure(limit, area, contact, force); });
  }
  return total_force(area, force);
}

}  // namespace dermis::live::threats
