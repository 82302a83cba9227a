// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/circuit_inversion.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace dermis::learn::health {

Result<CircuitInversion> CircuitInversion::create(const ArrayDescription& array, double noise_ratio) {
  auto inversion = touch::compensation::make_crosstalk_inversion(array, {.tolerance_ratio = 0.0});
  if (!inversion) return inversion.error();
  return CircuitInversion(array, *std::move(inversion), noise_ratio);
}

CircuitInversion::CircuitInversion(const ArrayDescription& array,
                                   std::unique_ptr<touch::compensation::CrosstalkInversion> inversion,
                                   double noise_ratio)
    : inversion_(std::move(inversion)),
      noise_ratio_(noise_ratio),
      falls_with_pressure_(!array.readout.pressure_raises_reading),
      siemens_(array.taxel_count()),
      sigma_siemens_(array.taxel_count()) {}

bool CircuitInversion::invert(std::vector<double> reading) {
  if (falls_with_pressure_) {
    for (double& value : reading) value = 1.0 - value;
  }
  inversion_->forget();
  const bool solved = inversion_->invert(reading, siemens_).solved;
  if (solved) {
    inversion_->propagate_noise(noise_ratio_, sigma_siemens_);
  } else {
    std::fill(siemens_.begin(), siemens_.end(), std::numeric_limits<double>::quiet_NaN());
    std::fill(sigma_siemens_.begin(), sigma_siemens_.end(), std::numeric_limits<double>::quiet_NaN());
  }
  return solved;
}

}  // namespace dermis::learn::health
