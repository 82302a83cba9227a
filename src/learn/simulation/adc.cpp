// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/adc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dermis::learn::simulation {

Adc::Adc(const Readout& readout, double noise_lsb)
    : full_scale_counts_(readout.full_scale_counts()),
      reference_v_(readout.adc_reference_v),
      noise_lsb_(noise_lsb),
      errors_(readout.adc_errors) {
  assert(noise_lsb >= 0.0);
}

double Adc::sent(double ideal_counts) const {
  const double offset = errors_.offset_counts.value_or(0.0);
  const std::vector<AdcPoint>& curve = errors_.curve;
  if (curve.empty()) return ideal_counts + offset;
  const auto above = std::find_if(curve.begin(), curve.end(),
                                  [&](const AdcPoint& point) { return point.ideal_counts > ideal_counts; });
  const AdcPoint& end = above == curve.begin() ? curve.front() : curve.back();
  if (above == curve.begin() || above == curve.end()) return end.sent_counts + ideal_counts - end.ideal_counts + offset;
  const AdcPoint& below = *(above - 1);
  const double share = (ideal_counts - below.ideal_counts) / (above->ideal_counts - below.ideal_counts);
  return std::lerp(below.sent_counts, above->sent_counts, share) + offset;
}

void Adc::convert(std::span<const double> ratio, double supply_v, Random& random, std::span<float> counts) const {
  assert(ratio.size() == counts.size() && supply_v > 0.0);
  const double counts_per_ratio = supply_v / reference_v_.value_or(supply_v) * full_scale_counts_;
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    const double exact = std::round(sent(ratio[i] * counts_per_ratio) + noise_lsb_ * random.normal());
    counts[i] = static_cast<float>(std::clamp(exact, 0.0, full_scale_counts_) + 0.0);  // no ADC says -0
  }
}

}  // namespace dermis::learn::simulation
