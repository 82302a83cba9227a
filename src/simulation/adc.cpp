// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/simulation/adc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace dermis::simulation {

Adc::Adc(const Readout& readout, double noise_lsb)
    : full_scale_counts_(readout.full_scale_counts()), reference_v_(readout.adc_reference_v), noise_lsb_(noise_lsb) {
  assert(noise_lsb >= 0.0);
}

void Adc::convert(std::span<const double> ratio, double supply_v, Random& random, std::span<float> counts) const {
  assert(ratio.size() == counts.size() && supply_v > 0.0);
  const double counts_per_ratio = supply_v / reference_v_.value_or(supply_v) * full_scale_counts_;
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    const double exact = std::round(ratio[i] * counts_per_ratio + noise_lsb_ * random.normal());
    counts[i] = static_cast<float>(std::clamp(exact, 0.0, full_scale_counts_) + 0.0);  // no ADC says -0
  }
}

}  // namespace dermis::simulation
