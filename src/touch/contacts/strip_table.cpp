// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/contacts/strip_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace dermis::touch::contacts {

StripTable::Place StripTable::at(double centre) const noexcept {
  const auto above = std::upper_bound(centre_m.begin(), centre_m.end(), centre);
  const auto right = std::clamp<std::ptrdiff_t>(above - centre_m.begin(), 1, std::ssize(centre_m) - 1);
  const auto upper = static_cast<std::size_t>(right);
  // Beyond the ends the sigma is that of the last piece: the position there is constant, but not because it is known.
  const double slope = (position_m[upper] - position_m[upper - 1]) / (centre_m[upper] - centre_m[upper - 1]);
  const double inside = std::clamp(centre, centre_m.front(), centre_m.back());
  return {position_m[upper - 1] + slope * (inside - centre_m[upper - 1]), slope};
}

bool StripTable::is_consistent() const noexcept {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return centre_m.size() >= 2 && position_m.size() == centre_m.size() &&
         std::all_of(centre_m.begin(), centre_m.end(), is_finite) &&
         std::all_of(position_m.begin(), position_m.end(), is_finite) &&
         std::adjacent_find(centre_m.begin(), centre_m.end(), std::greater_equal<>()) == centre_m.end() &&
         std::is_sorted(position_m.begin(), position_m.end()) && std::isfinite(sigma_m) && sigma_m >= 0.0;
}

}  // namespace dermis::touch::contacts
