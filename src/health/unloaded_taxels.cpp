// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "health/unloaded_taxels.hpp"

#include <algorithm>

namespace dermis::health {

void UnloadedTaxels::expect(const ConductanceFrame& conductance) {
  const auto& networks = model_.networks;
  const double offset_celsius = conductance.temperature_celsius.value_or(networks.temperature_centre_celsius) -
                                networks.temperature_centre_celsius;
  for (std::size_t taxel = 0; taxel < expected_.size(); ++taxel) {
    expected_[taxel] = networks.offset_siemens[taxel] + networks.offset_per_celsius[taxel] * offset_celsius;
  }
}

bool UnloadedTaxels::is_touched(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
  const double least = 3.0 * std::max(expected_[taxel], 0.0) + sigmas * conductance.sigma_siemens[taxel];
  return conductance.siemens[taxel] > least;
}

bool UnloadedTaxels::is_near_touch(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
  constexpr std::size_t kReach = 3;  // taxels around a touched one that may be touched a little
  const ArrayDescription& array = model_.array;
  const std::size_t row = taxel / array.cols;
  const std::size_t col = taxel % array.cols;
  for (std::size_t i = row - std::min(row, kReach); i <= std::min(row + kReach, array.rows - 1); ++i) {
    for (std::size_t j = col - std::min(col, kReach); j <= std::min(col + kReach, array.cols - 1); ++j) {
      if (is_touched(conductance, array.index(i, j), sigmas)) return true;
    }
  }
  return false;
}

}  // namespace dermis::health
