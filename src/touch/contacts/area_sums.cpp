// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/area_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::touch::contacts {
namespace {

void sum_forces(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels,
                Contact& contact) {
  double variance = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double newtons = force.newtons[taxel];
    const double sigma = force.sigma_newtons[taxel];
    contact.force_n += newtons;
    variance += sigma * sigma;
    contact.position.x += newtons * plane.centre(taxel).x;
    contact.position.y += newtons * plane.centre(taxel).y;
  }
  const auto count = static_cast<double>(taxels.size());
  contact.position.x /= contact.force_n;
  contact.position.y /= contact.force_n;
  contact.sigma_position_m = {0.2 * plane.col_pitch_m / std::sqrt(count), 0.2 * plane.row_pitch_m / std::sqrt(count)};
  contact.sigma_force_n = std::sqrt(variance);
  contact.area_m2 = count * plane.row_pitch_m * plane.col_pitch_m;
  contact.peak_pressure_pa = force.newtons[taxels.front()] / plane.taxel_area_m2;
  contact.mean_pressure_pa = contact.force_n / (count * plane.taxel_area_m2);
  contact.taxels = static_cast<std::uint32_t>(taxels.size());
}

void find_axes(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels,
               Contact& contact) {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const std::uint32_t taxel : taxels) {
    const double share = force.newtons[taxel] / contact.force_n;
    const PlaneVector place = plane.centre(taxel);
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

}  // namespace

Contact sum_up(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels) {
  Contact contact;
  sum_forces(plane, force, taxels, contact);
  find_axes(plane, force, taxels, contact);
  return contact;
}

PlaneVector centre_of_mass(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels,
                           PlaneVector of_forces) {
  double sum = 0.0;
  PlaneVector first;
  for (const std::uint32_t taxel : taxels) {
    const double weight = std::sqrt(force.newtons[taxel] * force.signal_to_noise[taxel]);
    sum += weight;
    first.x += weight * plane.centre(taxel).x;
    first.y += weight * plane.centre(taxel).y;
  }
  if (!std::isfinite(sum)) return of_forces;
  return {first.x / sum, first.y / sum};
}

}  // namespace dermis::touch::contacts
