// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/supply_bounds.hpp"

#include <algorithm>

#include "dermis/touch/frames/number_text.hpp"

namespace dermis::touch::preprocessing {
namespace {

constexpr double kUsualTolerance = 0.1;     // of a supply; within it the law of the circuit needs no proof
constexpr double kMeterError = 0.01;        // of what measures the supply
constexpr double kPlausible = 0.2;          // beyond nominal
constexpr double kMostFactor = 3.0;         // of nominal
constexpr double kMostOfReference = 100.0;  // where nothing but the ADC's reference is known
constexpr double kMillivolts = 1000.0;      // per volt

SupplyRange around(double supply_v, double tolerance) {
  return {(1.0 - tolerance) * supply_v, (1.0 + tolerance) * supply_v};
}

SupplyRange within_factor(double supply_v, double factor) {
  return {supply_v / factor, factor * supply_v};
}

SupplyRange hull(const SupplyRange& a, const SupplyRange& b) {
  return {std::min(a.least_v, b.least_v), std::max(a.most_v, b.most_v)};
}

std::optional<double> nominal_of(const Readout& readout, const std::optional<SupplyRange>& calibrated) {
  if (readout.supply_v || !calibrated) return readout.supply_v;
  return 0.5 * (calibrated->least_v + calibrated->most_v);
}

}  // namespace

SupplyBounds::SupplyBounds(const Readout& readout) {
  if (!readout.adc_reference_v) return;
  possible_ = readout.supply_v ? within_factor(*readout.supply_v, kMostFactor)
                               : within_factor(*readout.adc_reference_v, kMostOfReference);
}

SupplyBounds::SupplyBounds(const Readout& readout, const std::optional<SupplyRange>& calibrated)
    : SupplyBounds(readout) {
  const std::optional<double> nominal_v = nominal_of(readout, calibrated);
  if (!readout.adc_reference_v || !nominal_v) return;
  nominal_v_ = *nominal_v;
  possible_ = within_factor(*nominal_v, kMostFactor);
  plausible_ = around(*nominal_v, kPlausible);
  trusted_ = plausible_;
  if (!calibrated) return;
  const SupplyRange proven = hull(*calibrated, around(*nominal_v, kUsualTolerance));
  trusted_ = {(1.0 - kMeterError) * proven.least_v, (1.0 + kMeterError) * proven.most_v};
}

bool SupplyBounds::is_in_millivolts(double supply_v) const noexcept {
  return !is_possible(supply_v) && is_possible(supply_v / kMillivolts);
}

std::string SupplyBounds::describe_impossible(double supply_v) const {
  std::string text = "a supply of " + significant_digits(supply_v, 4) + " V (" +
                     significant_digits(possible_.least_v, 3) + " to " + significant_digits(possible_.most_v, 3) +
                     " V are possible)";
  text += is_in_millivolts(supply_v) ? ": it looks like millivolts, give volts" : ": check what measures it";
  return text;
}

}  // namespace dermis::touch::preprocessing
