// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/taxel_plane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "touch/contacts/strip.hpp"

namespace dermis::touch::contacts {
namespace {

double taxel_area(const ArrayDescription& array) {
  const double diameter = 0.7 * std::min(array.row_pitch_m, array.col_pitch_m);
  return array.taxel_area_m2.value_or(std::numbers::pi / 4.0 * diameter * diameter);
}

/// The mean of both axes [m]; 0 without a cover, and on a strip. A disc of a cell's area is a little narrower than the
/// cell: what its variance lacks is added.
double cover_spread_m(const ArrayDescription& array) {
  if (!array.cover || array.cover->is_unknown() || strip_pitch_m(array)) return 0.0;
  const CoverKernel kernel(array);
  constexpr double kCellOverDisc = 1.0 / 12.0 - 0.25 / std::numbers::pi;
  const double spread = kernel.row_spread_m() * kernel.col_spread_m();
  return spread > 0.0 ? std::sqrt(spread + kCellOverDisc * array.row_pitch_m * array.col_pitch_m) : 0.0;
}

/// Taxels of a strip may be long across it.
double taxel_radius(const ArrayDescription& array) {
  if (cover_spread_m(array) > 0.0) return std::sqrt(array.row_pitch_m * array.col_pitch_m / std::numbers::pi);
  const double radius = std::sqrt(taxel_area(array) / std::numbers::pi);
  const std::optional<double> pitch = strip_pitch_m(array);
  return pitch ? std::min(radius, 0.5 * *pitch) : radius;
}

}  // namespace

TaxelPlane::TaxelPlane(const ArrayDescription& array)
    : rows(array.rows),
      cols(array.cols),
      row_pitch_m(array.row_pitch_m),
      col_pitch_m(array.col_pitch_m),
      taxel_area_m2(taxel_area(array)),
      taxel_radius_m(taxel_radius(array)),
      cover_spread(cover_spread_m(array) / taxel_radius_m),
      responses(PatchResponses::of(cover_spread)) {
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    places.push_back({centre(taxel).x / taxel_radius_m, centre(taxel).y / taxel_radius_m});
  }
}

bool TaxelPlane::are_neighbours(std::size_t a, std::size_t b) const noexcept {
  const std::size_t row_distance = std::max(a / cols, b / cols) - std::min(a / cols, b / cols);
  const std::size_t col_distance = std::max(a % cols, b % cols) - std::min(a % cols, b % cols);
  return row_distance <= 1 && col_distance <= 1;
}

}  // namespace dermis::touch::contacts
