// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/preprocessing/conditioner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis::preprocessing {
namespace {

bool is_finite_or_absent(const std::optional<double>& value) {
  return !value || std::isfinite(*value);
}

}  // namespace

const char* to_string(Rejection rejection) noexcept {
  switch (rejection) {
    case Rejection::none: return "none";
    case Rejection::wrong_shape: return "wrong number of readings";
    case Rejection::not_a_number: return "a value that is not a number";
    case Rejection::outside_adc_range: return "a reading outside the ADC range";
    case Rejection::supply_not_positive: return "a supply of 0 V or less";
    case Rejection::supply_unknown: return "no supply voltage (add supply_v to the frames or to array.toml)";
    case Rejection::time_going_backwards: return "time going backwards";
  }
  return "none";
}

Conditioner::Conditioner(ArrayDescription array)
    : array_(std::move(array)), full_scale_counts_(array_.readout.full_scale_counts()) {}

Rejection Conditioner::inspect(const RawFrame& raw) const noexcept {
  if (raw.counts.size() != array_.taxel_count()) return Rejection::wrong_shape;
  if (!is_finite_or_absent(raw.temperature_celsius) || !is_finite_or_absent(raw.supply_v)) {
    return Rejection::not_a_number;
  }
  if (raw.supply_v && *raw.supply_v <= 0.0) return Rejection::supply_not_positive;
  const Readout& readout = array_.readout;
  const bool needs_supply = readout.adc_reference_v && readout.circuit != Circuit::none;
  if (needs_supply && !raw.supply_v && !readout.supply_v) return Rejection::supply_unknown;
  for (const float count : raw.counts) {
    if (!std::isfinite(count)) return Rejection::not_a_number;
    if (count < 0.0F || static_cast<double>(count) > full_scale_counts_) return Rejection::outside_adc_range;
  }
  if (last_time_ && raw.time < *last_time_) return Rejection::time_going_backwards;
  return Rejection::none;
}

void Conditioner::process(const RawFrame& raw, ConditionedFrame& conditioned) noexcept {
  conditioned.time = raw.time;
  conditioned.temperature_celsius = raw.temperature_celsius;
  conditioned.status = FrameStatus::ok;
  conditioned.ratio.resize(array_.taxel_count());
  conditioned.taxels.resize(array_.taxel_count());
  rejection_ = inspect(raw);
  if (rejection_ == Rejection::time_going_backwards) last_time_ = raw.time;
  if (rejection_ != Rejection::none) {
    conditioned.status = FrameStatus::rejected;
    std::fill(conditioned.ratio.begin(), conditioned.ratio.end(), 0.0);
    std::fill(conditioned.taxels.begin(), conditioned.taxels.end(), TaxelStatus::invalid);
    return;
  }
  last_time_ = raw.time;
  convert(raw, conditioned);
}

void Conditioner::convert(const RawFrame& raw, ConditionedFrame& conditioned) const noexcept {
  const Readout& readout = array_.readout;
  const std::optional<double> supply_v = raw.supply_v ? raw.supply_v : readout.supply_v;
  const double reference = readout.adc_reference_v && supply_v ? *readout.adc_reference_v / *supply_v : 1.0;
  const double scale = (readout.pressure_raises_reading ? reference : -reference) / full_scale_counts_;
  conditioned.sigma_ratio = std::abs(scale) * readout.adc_noise_counts;
  const double zero = readout.pressure_raises_reading ? 0.0 : 1.0;
  constexpr float kHalfCount = 0.5F;  // averaged readings
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const float highest = readout.pressure_raises_reading ? static_cast<float>(full_scale_counts_) - kHalfCount : kNever;
  const float lowest = readout.pressure_raises_reading ? -kNever : kHalfCount;
  bool any_saturated = false;
  for (std::size_t taxel = 0; taxel < raw.counts.size(); ++taxel) {
    conditioned.ratio[taxel] = zero + scale * static_cast<double>(raw.counts[taxel]);
    const bool saturated = raw.counts[taxel] > highest || raw.counts[taxel] < lowest;
    conditioned.taxels[taxel] = saturated ? TaxelStatus::saturated : TaxelStatus::ok;
    any_saturated = any_saturated || saturated;
  }
  if (any_saturated) conditioned.status |= FrameStatus::saturated;
}

void bare_readings(const ArrayDescription& array, const RawFrame& raw, std::span<double> reading) noexcept {
  const double full_scale = array.readout.full_scale_counts();
  for (std::size_t taxel = 0; taxel < reading.size(); ++taxel) {
    const double share = static_cast<double>(raw.counts[taxel]) / full_scale;
    reading[taxel] = array.readout.pressure_raises_reading ? share : 1.0 - share;
  }
}

}  // namespace dermis::preprocessing
