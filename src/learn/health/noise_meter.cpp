// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/noise_meter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {

void NoiseMeter::add(const std::vector<double>& deviations) {
  constexpr std::size_t kLeastTaxels = 8;
  differences_.clear();
  for (std::size_t taxel = 0; taxel < last_.size(); ++taxel) {
    const double difference = std::abs(deviations[taxel] - last_[taxel]);
    if (!std::isnan(difference)) differences_.push_back(difference);
  }
  last_ = deviations;
  if (differences_.size() >= kLeastTaxels) ratios_.push_back(rms_without_outliers() / std::sqrt(2.0));
}

std::optional<double> NoiseMeter::ratio() const {
  if (ratios_.empty()) return std::nullopt;
  return upper_median(ratios_);
}

double NoiseMeter::rms_without_outliers() const {
  constexpr int kRounds = 10;
  double limit = std::numeric_limits<double>::infinity();
  double rms = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double square = 0.0;
    double count = 0.0;
    for (const double difference : differences_) {
      if (difference > limit) continue;
      square += difference * difference;
      count += 1.0;
    }
    rms = std::sqrt(square / std::max(count, 1.0));
    limit = std::max(3.0 * rms, 1.0);
  }
  return rms;
}

}  // namespace dermis::learn::health
