// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/adc_correction.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace dermis::touch::preprocessing {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double slope_between(const AdcPoint& below, const AdcPoint& above) {
  return (above.ideal_counts - below.ideal_counts) / (above.sent_counts - below.sent_counts);
}

/// The taxel of each reading, in the order in which the device sends them.
std::vector<std::size_t> scan_of(const ArrayDescription& array) {
  const FrameShape sent = array.order.sent({array.rows, array.cols});
  const std::vector<std::size_t> places = array.order.sent_places(sent);
  std::vector<std::size_t> taxel_at(sent.taxel_count(), places.size());
  for (std::size_t taxel = 0; taxel < places.size(); ++taxel) taxel_at[places[taxel]] = taxel;
  std::erase(taxel_at, places.size());  // columns that are skipped
  return taxel_at;
}

}  // namespace

double noise_gain(const AdcErrors& errors) noexcept {
  const double kept = errors.settling.value_or(0.0);
  return kept == 0.0 ? 1.0 : std::hypot(1.0, kept) / (1.0 - kept);
}

AdcCorrection::AdcCorrection(const ArrayDescription& array)
    : readout_(array.readout),
      most_counts_(static_cast<float>(readout_.full_scale_counts())),
      kept_(readout_.adc_errors.settling.value_or(0.0)),
      scan_(scan_of(array)),
      ideal_(array.taxel_count()),
      held_(kUnknown) {
  assert(!readout_.adc_errors.is_unknown());
}

void AdcCorrection::forget() noexcept {
  held_ = kUnknown;
}

bool AdcCorrection::is_at_rail(float counts) const noexcept {
  constexpr double kHalfCount = 0.5;  // averaged readings
  const auto sent = static_cast<double>(counts);
  if (readout_.pressure_raises_reading) {
    return sent > readout_.rail_counts.value_or(readout_.full_scale_counts()) - kHalfCount;
  }
  return sent < readout_.rail_counts.value_or(0.0) + kHalfCount;
}

/// Null: beyond the last.
const AdcPoint* AdcCorrection::point_above(double sent_counts) const noexcept {
  const std::vector<AdcPoint>& curve = readout_.adc_errors.curve;
  const auto above = std::upper_bound(curve.begin(), curve.end(), sent_counts,
                                      [](double sent, const AdcPoint& point) { return sent < point.sent_counts; });
  return above == curve.end() ? nullptr : &*above;
}

double AdcCorrection::straight(float counts) const noexcept {
  const std::vector<AdcPoint>& curve = readout_.adc_errors.curve;
  const double sent = static_cast<double>(counts) - readout_.adc_errors.offset_counts.value_or(0.0);
  if (curve.empty()) return sent;
  const AdcPoint* const above = point_above(sent);
  if (above == nullptr) return curve.back().ideal_counts + sent - curve.back().sent_counts;
  if (above == &curve.front()) return above->ideal_counts + sent - above->sent_counts;
  const AdcPoint& below = *(above - 1);
  return below.ideal_counts + slope_between(below, *above) * (sent - below.sent_counts);
}

std::span<const float> AdcCorrection::correct(std::span<const float> counts) noexcept {
  assert(counts.size() == ideal_.size());
  for (const std::size_t taxel : scan_) {
    const float sent = counts[taxel];
    ideal_[taxel] = sent;
    if (!is_reading(sent)) {
      held_ = kUnknown;
      continue;
    }
    const double voltage = straight(sent);
    const double before = std::isnan(held_) ? voltage : held_;
    const double settled = is_at_rail(sent) ? voltage : (voltage - kept_ * before) / (1.0 - kept_);
    ideal_[taxel] = static_cast<float>(settled);
    held_ = voltage;
  }
  return ideal_;
}

void AdcCorrection::find_slopes(std::span<const float> counts, std::vector<float>& slopes) const {
  const std::vector<AdcPoint>& curve = readout_.adc_errors.curve;
  if (curve.empty()) return;
  slopes.resize(counts.size());
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
    const double sent = static_cast<double>(counts[taxel]) - readout_.adc_errors.offset_counts.value_or(0.0);
    const AdcPoint* const above = point_above(sent);
    const bool is_inside = above != nullptr && above != &curve.front();
    slopes[taxel] = is_inside ? static_cast<float>(slope_between(*(above - 1), *above)) : 1.0F;
  }
}

}  // namespace dermis::touch::preprocessing
