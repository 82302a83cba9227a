// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/unloaded_taxels.hpp"

#include <algorithm>

#include "dermis/touch/frames/neighbours.hpp"
#include "dermis/touch/frames/touch.hpp"

namespace dermis::learn::health {

void UnloadedTaxels::expect(const ConductanceFrame& conductance) {
  const UnloadedLaw& unloaded = model_.networks.unloaded;
  const double centre_celsius = unloaded.temperature.centre_celsius;
  for (std::size_t taxel = 0; taxel < expected_.size(); ++taxel) {
    expected_[taxel] = unloaded.at(taxel, conductance.celsius(taxel).value_or(centre_celsius) - centre_celsius);
  }
}

bool UnloadedTaxels::is_touched(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
  const double unloaded = std::max(expected_[taxel], 0.0);
  return conductance.siemens[taxel] > touched_above(unloaded, conductance.sigma_siemens[taxel], sigmas);
}

bool UnloadedTaxels::is_near_touch(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
  constexpr PerAxis<std::size_t> kReach{.row = 3, .column = 3};  // taxels around that may be touched a little
  for (const std::size_t near : Neighbours(model_.array.rows, model_.array.cols, taxel, kReach)) {
    if (is_touched(conductance, near, sigmas)) return true;
  }
  return false;
}

}  // namespace dermis::learn::health
