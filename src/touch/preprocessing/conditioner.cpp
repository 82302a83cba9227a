// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/conditioner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/mean_celsius.hpp"
#include "dermis/touch/frames/neighbours.hpp"
#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::preprocessing {
namespace {

/// NaN is how recordings without a sensor write its column.
std::optional<double> without_nan(const std::optional<double>& value) {
  return value && std::isnan(*value) ? std::nullopt : value;
}

/// Ratio of the taxels around one that have a reading; 0 where none has.
double mean_of_neighbours(const ArrayDescription& array, const ConditionedFrame& conditioned, std::size_t taxel) {
  double sum = 0.0;
  double count = 0.0;
  for (const std::size_t near : Neighbours(array.rows, array.cols, taxel)) {
    if (conditioned.taxels[near] == TaxelStatus::invalid) continue;
    sum += conditioned.ratio[near];
    count += 1.0;
  }
  return sum / std::max(count, 1.0);
}

}  // namespace

const char* to_string(Rejection rejection) noexcept {
  switch (rejection) {
    case Rejection::none: return "none";
    case Rejection::wrong_shape: return "wrong number of readings";
    case Rejection::not_a_number: return "a value that is not a number";
    case Rejection::too_few_readings: return "more than half of the readings are missing or outside the ADC range";
    case Rejection::supply_not_positive: return "a supply of 0 V or less";
    case Rejection::supply_impossible: return "a supply that the array cannot have";
    case Rejection::supply_in_millivolts: return "a supply that looks like millivolts, give volts";
    case Rejection::supply_unknown: return "no supply voltage (add supply_v to the frames or to array.toml)";
    case Rejection::time_going_backwards: return "time going backwards";
  }
  return "none";
}

Conditioner::Conditioner(const ArrayDescription& array, const SupplyBounds& supply_bounds)
    : array_(array),
      supply_bounds_(supply_bounds),
      full_scale_counts_(static_cast<float>(array_.readout.full_scale_counts())),
      least_counts_(array_.readout.quantity == Quantity::counts ? 0.0F : -full_scale_counts_),
      highest_counts_(std::numeric_limits<float>::infinity()),
      lowest_counts_(-highest_counts_) {
  constexpr float kHalfCount = 0.5F;  // averaged readings
  AdcErrors& errors = array_.readout.adc_errors;
  if (errors.is_unknown()) errors = {{}, {}, errors.curve};  // calibration has yet to find them
  if (errors.any()) adc_.emplace(array_);
  if (!array_.temperature_sensors.empty()) temperatures_.emplace(array_);
  const Readout& readout = array_.readout;
  if (readout.pressure_raises_reading) {
    highest_counts_ = static_cast<float>(readout.rail_counts.value_or(readout.full_scale_counts())) - kHalfCount;
  } else {
    lowest_counts_ = static_cast<float>(readout.rail_counts.value_or(0.0)) + kHalfCount;
  }
}

Conditioner::Conditioner(const ArrayDescription& array) : Conditioner(array, SupplyBounds(array.readout)) {}

Conditioner::Conditioner(const ArrayDescription& array, const std::optional<SupplyRange>& calibrated)
    : Conditioner(array, SupplyBounds(array.readout, calibrated)) {}

std::string Conditioner::why_rejected() const {
  switch (rejection_) {
    case Rejection::none: return "";
    case Rejection::supply_impossible:
    case Rejection::supply_in_millivolts: return supply_bounds_.describe_impossible(rejected_supply_v_);
    default: return to_string(rejection_);
  }
}

/// Taxels of the sheet without a reading.
DERMIS_PROCESSOR_CLONES std::size_t Conditioner::count_missing(const RawFrame& raw) const noexcept {
  const float least = least_counts_;
  const float most = full_scale_counts_;
  std::uint32_t readings = 0;
  for (const float count : raw.counts) readings += (count >= least ? 1U : 0U) & (count <= most ? 1U : 0U);
  std::size_t missing = raw.counts.size() - readings;
  for (const std::size_t taxel : array_.absent) missing -= is_reading(raw.counts[taxel]) ? 0 : 1;
  return missing;
}

Rejection Conditioner::inspect(const RawFrame& raw) const noexcept {
  if (raw.counts.size() != array_.taxel_count()) return Rejection::wrong_shape;
  if (raw.temperature_celsius && std::isinf(*raw.temperature_celsius)) return Rejection::not_a_number;
  if (const Rejection supply = inspect_supply(raw); supply != Rejection::none) return supply;
  if (last_time_ && raw.time < *last_time_) return Rejection::time_going_backwards;
  return Rejection::none;
}

Rejection Conditioner::inspect_supply(const RawFrame& raw) const noexcept {
  const Readout& readout = array_.readout;
  if (!raw.supply_v) {
    const bool needs_supply = readout.adc_reference_v && readout.circuit != Circuit::none;
    return needs_supply && !readout.supply_v ? Rejection::supply_unknown : Rejection::none;
  }
  const double supply_v = *raw.supply_v;
  if (!std::isfinite(supply_v)) return Rejection::not_a_number;
  if (supply_v <= 0.0) return Rejection::supply_not_positive;
  if (supply_bounds_.is_possible(supply_v)) return Rejection::none;
  return supply_bounds_.is_in_millivolts(supply_v) ? Rejection::supply_in_millivolts : Rejection::supply_impossible;
}

void Conditioner::process(const RawFrame& raw, ConditionedFrame& conditioned) noexcept {
  conditioned.time = raw.time;
  find_temperatures(raw, conditioned);
  conditioned.status = FrameStatus::ok;
  conditioned.supply_doubt = 0.0;
  conditioned.ratio.resize(array_.taxel_count());
  conditioned.taxels.resize(array_.taxel_count());
  rejection_ = inspect(raw);
  if (rejection_ == Rejection::time_going_backwards) last_time_ = raw.time;
  const std::size_t missing = rejection_ == Rejection::none ? count_missing(raw) : 0;
  if (2 * missing > array_.taxel_count() - array_.absent.size()) rejection_ = Rejection::too_few_readings;
  if (rejection_ != Rejection::none) {
    if (adc_) adc_->forget();
    rejected_supply_v_ = raw.supply_v.value_or(0.0);
    conditioned.status = FrameStatus::rejected;
    std::fill(conditioned.ratio.begin(), conditioned.ratio.end(), 0.0);
    std::fill(conditioned.taxels.begin(), conditioned.taxels.end(), TaxelStatus::invalid);
    return;
  }
  last_time_ = raw.time;
  convert(raw, conditioned);
  if (missing > 0 || !array_.absent.empty()) mark_missing(raw, conditioned);
  if (raw.supply_v && !supply_bounds_.trusted().contains(*raw.supply_v)) doubt_supply(*raw.supply_v, conditioned);
}

void Conditioner::find_temperatures(const RawFrame& raw, ConditionedFrame& conditioned) noexcept {
  conditioned.temperature_celsius = without_nan(raw.temperature_celsius);
  if (!temperatures_ || !temperatures_->interpolate(raw.sensor_celsius, conditioned.taxel_celsius)) return;
  conditioned.temperature_celsius = mean_celsius(std::span<const float>(conditioned.taxel_celsius));
}

DERMIS_PROCESSOR_CLONES void Conditioner::convert(const RawFrame& raw, ConditionedFrame& conditioned) noexcept {
  const Readout& readout = array_.readout;
  const std::optional<double> supply_v = raw.supply_v ? supply_bounds_.used(*raw.supply_v) : readout.supply_v;
  const double reference = readout.adc_reference_v && supply_v ? *readout.adc_reference_v / *supply_v : 1.0;
  const double scale = (readout.pressure_raises_reading ? reference : -reference) / readout.full_scale_counts();
  conditioned.sigma_ratio = std::abs(scale) * readout.adc_noise_counts * noise_gain(readout.adc_errors);
  if (adc_) adc_->find_slopes(raw.counts, conditioned.noise_gain);
  const double zero = readout.pressure_raises_reading ? 0.0 : 1.0;
  const std::size_t taxels = raw.counts.size();
  const float* const counts = raw.counts.data();
  double* const ratio = conditioned.ratio.data();
  const float* const ideal = adc_ ? adc_->correct(raw.counts).data() : counts;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) ratio[taxel] = zero + scale * static_cast<double>(ideal[taxel]);
  const float highest = highest_counts_;
  const float lowest = lowest_counts_;
  std::uint32_t saturated = 0;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    saturated |= (counts[taxel] > highest ? 1U : 0U) | (counts[taxel] < lowest ? 1U : 0U);
  }
  std::fill(conditioned.taxels.begin(), conditioned.taxels.end(), TaxelStatus::ok);
  if (saturated != 0) mark_saturated(raw, conditioned);
}

void Conditioner::doubt_supply(double measured_v, ConditionedFrame& conditioned) const noexcept {
  conditioned.supply_doubt = supply_bounds_.doubt(measured_v);
  conditioned.status |=
      supply_bounds_.is_plausible(measured_v) ? FrameStatus::supply_clamped : FrameStatus::supply_implausible;
}

void Conditioner::mark_saturated(const RawFrame& raw, ConditionedFrame& conditioned) const noexcept {
  conditioned.status |= FrameStatus::saturated;
  for (std::size_t taxel = 0; taxel < raw.counts.size(); ++taxel) {
    const float count = raw.counts[taxel];
    if (count > highest_counts_ || count < lowest_counts_) conditioned.taxels[taxel] = TaxelStatus::saturated;
  }
}

void Conditioner::mark_missing(const RawFrame& raw, ConditionedFrame& conditioned) const noexcept {
  std::vector<TaxelStatus>& status = conditioned.taxels;
  for (std::size_t taxel = 0; taxel < status.size(); ++taxel) {
    if (!is_reading(raw.counts[taxel])) status[taxel] = TaxelStatus::invalid;
  }
  for (const std::size_t taxel : array_.absent) status[taxel] = TaxelStatus::invalid;
  const bool any_saturated = std::find(status.begin(), status.end(), TaxelStatus::saturated) != status.end();
  conditioned.status = any_saturated ? FrameStatus::saturated : FrameStatus::ok;
  for (std::size_t taxel = 0; taxel < status.size(); ++taxel) {
    if (status[taxel] == TaxelStatus::invalid)
      conditioned.ratio[taxel] = mean_of_neighbours(array_, conditioned, taxel);
  }
  for (const std::size_t taxel : array_.absent) conditioned.ratio[taxel] = 0.0;
}

void bare_readings(const ArrayDescription& array, const RawFrame& raw, std::span<double> reading) noexcept {
  const double full_scale = array.readout.full_scale_counts();
  for (std::size_t taxel = 0; taxel < reading.size(); ++taxel) {
    const double share = static_cast<double>(raw.counts[taxel]) / full_scale;
    const bool is_reading = share >= 0.0 && share <= 1.0;
    reading[taxel] = is_reading ? (array.readout.pressure_raises_reading ? share : 1.0 - share) : 0.0;
  }
}

}  // namespace dermis::touch::preprocessing
