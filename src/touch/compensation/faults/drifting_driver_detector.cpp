// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/drifting_driver_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/faults/untouched.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr LineFaultKind kKind = LineFaultKind::drifting_driver;
constexpr double kSigmas = 5.0;       // when the current rises and when it falls
constexpr double kMostOutlier = 3.0;  // standard deviations
constexpr double kLeastSag = 0.03;    // of the typical loaded line
constexpr double kLeastShare = 0.25;  // of the driver's resistance
constexpr double kLeastPairs = 20.0;
constexpr std::size_t kLinesPerFrame = 3;  // no divisor of usual numbers of lines: recurring loads meet all
constexpr double kMemory = 0.998;          // per pair of frames
constexpr double kDoubtOfUnloaded = 0.1;   // relative, from one frame to the next: temperature, memory

bool masks_taxels(const LineFault& fault) {
  return fault.kind != kKind;
}

}  // namespace

void DriftingDriverDetector::Fit::add(double slope, double value, double variance, double load) {
  normal = kMemory * normal + slope * slope / variance;
  moment = kMemory * moment + slope * value / variance;
  square = kMemory * square + value * value / variance;
  loads = kMemory * loads + slope * slope / variance * load * load;
  pairs = kMemory * pairs + 1.0;
}

/// Takes the scatter of the fitted values, which memory of the material makes wider than noise alone.
double DriftingDriverDetector::Fit::deviation() const {
  const double scatter = (square - moment * moment / normal) / pairs;
  return std::sqrt(std::max(scatter, 1.0) / normal);
}

double DriftingDriverDetector::Fit::typical_siemens() const {
  return std::sqrt(loads / normal);
}

DriftingDriverDetector::DriftingDriverDetector(const ArrayDescription& array)
    : array_(array),
      drivers_(array.driven_lines()),
      touched_(array.sensed_lines() + 2 * kContactReach),
      near_touch_(array.sensed_lines()),
      last_siemens_(array.taxel_count()),
      last_line_siemens_(array.driven_lines()) {}

void DriftingDriverDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  const bool can_judge = seen.solved && knows_what_currents_take(array_.readout) &&
                         std::none_of(faults.all().begin(), faults.all().end(), masks_taxels);
  const bool has_last = std::exchange(has_last_, can_judge);
  if (!can_judge) return;
  for (std::size_t turn = 0; turn < kLinesPerFrame && has_last; ++turn) {
    compare_with_last(seen, (kLinesPerFrame * seen.frame + turn) % drivers_.size(), faults);
  }
  remember(seen);
}

void DriftingDriverDetector::compare_with_last(const Observation& seen, std::size_t line, FaultList& faults) noexcept {
  const double rise = seen.sums.driven_siemens()[line] - last_line_siemens_[line];
  auto [now, last, variance, unloaded_siemens] = untouched_pair(seen, line);
  if (std::abs(rise) < kTouchedShare * unloaded_siemens || !(variance > 0.0)) return;
  Driver& driver = drivers_[line];
  if (driver.fallen.pairs + driver.risen.pairs == 0.0) {
    driver.first_frame = seen.frame;
    driver.first_time = seen.conditioned.time;
  }
  const double mean = 0.5 * (now + last);
  variance += std::pow(kDoubtOfUnloaded * mean, 2);
  const double most = kMostOutlier * std::sqrt(variance);
  Fit& fit = rise > 0.0 ? driver.risen : driver.fallen;
  fit.add(mean * rise, std::clamp(last - now, -most, most), variance, rise);
  judge_driver(line, faults);
}

DriftingDriverDetector::Pair DriftingDriverDetector::untouched_pair(const Observation& seen,
                                                                    std::size_t line) noexcept {
  find_touched(seen, line);
  const Axis driven = driven_axis(array_);
  Pair pair;
  for (std::size_t place = 0; place < near_touch_.size(); ++place) {
    const std::size_t taxel = taxel_on_line(array_, driven, line, place);
    const double unloaded_siemens = seen.unloaded.siemens()[taxel];
    pair.unloaded_siemens += unloaded_siemens;
    if (!(unloaded_siemens > 0.0) || near_touch_[place] != 0) continue;
    const double sigma_siemens = seen.conductance.sigma_siemens[taxel];
    pair.now += seen.conductance.siemens[taxel];
    pair.last += last_siemens_[taxel];
    pair.variance += 2.0 * sigma_siemens * sigma_siemens;
  }
  return pair;
}

/// Finds where a line or one beside it is touched, or nearly. There a taxel reads more than an unloaded one, in this
/// frame or the last.
void DriftingDriverDetector::find_touched(const Observation& seen, std::size_t line) noexcept {
  std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
  for (std::size_t near = line - std::min<std::size_t>(line, 1); near <= std::min(line + 1, drivers_.size() - 1);
       ++near) {
    add_touched(seen, near);
  }
  const std::size_t places = array_.sensed_lines();
  std::uint8_t* const near_touch = near_touch_.data();
  const std::uint8_t* const touched = touched_.data();  // of places -kContactReach ...
  std::fill_n(near_touch, places, std::uint8_t{0});
  for (std::size_t shift = 0; shift <= 2 * kContactReach; ++shift) {
    for (std::size_t place = 0; place < places; ++place) near_touch[place] |= touched[place + shift];
  }
}

DERMIS_PROCESSOR_CLONES void DriftingDriverDetector::add_touched(const Observation& seen, std::size_t line) noexcept {
  const Axis driven = driven_axis(array_);
  const std::size_t places = array_.sensed_lines();
  const std::size_t from = taxel_on_line(array_, driven, line, 0);
  const std::size_t step = driven == Axis::row ? 1 : array_.cols;
  const double* const siemens = seen.conductance.siemens.data() + from;
  const double* const sigma_siemens = seen.conductance.sigma_siemens.data() + from;
  const double* const unloaded = seen.unloaded.siemens().data() + from;
  const double* const last = last_siemens_.data() + from;
  std::uint8_t* const touched = touched_.data() + kContactReach;
  for (std::size_t place = 0; place < places; ++place) {
    const std::size_t taxel = place * step;
    const double most = UnloadedTaxels::most_siemens(unloaded[taxel], sigma_siemens[taxel]);
    const double larger = siemens[taxel] > last[taxel] ? siemens[taxel] : last[taxel];
    touched[place] = static_cast<std::uint8_t>(touched[place] | (larger > most ? 1 : 0));
  }
}

void DriftingDriverDetector::judge_driver(std::size_t line, FaultList& faults) noexcept {
  const auto& [fallen, risen, first_frame, first_time] = drivers_[line];
  if (std::min(fallen.pairs, risen.pairs) < kLeastPairs) return;
  const double nominal_ohm = array_.readout.drive_ohm[line];
  const double least_sag_ohm = kLeastSag / std::max(fallen.typical_siemens(), risen.typical_siemens());
  const double least_ohm = std::max(kLeastShare * nominal_ohm, least_sag_ohm);
  const auto has_risen = [&](const Fit& fit) {
    return fit.estimate() > std::max(kSigmas * fit.deviation(), least_ohm);
  };
  const auto is_nominal = [&](const Fit& fit) { return fit.estimate() + fit.deviation() < least_ohm; };
  const double ohm = nominal_ohm + (fallen.moment + risen.moment) / (fallen.normal + risen.normal);
  const std::span<LineFault> all = faults.all();
  const auto known = std::find_if(
      all.begin(), all.end(), [line](const LineFault& fault) { return fault.kind == kKind && fault.place == line; });
  if (known != all.end()) {
    known->drive_ohm = ohm;
    if (is_nominal(fallen) && is_nominal(risen)) faults.remove(kKind, line);
  } else if (has_risen(fallen) && has_risen(risen)) {
    faults.add({.kind = kKind, .place = line, .frame = first_frame, .time = first_time, .drive_ohm = ohm});
  }
}

void DriftingDriverDetector::remember(const Observation& seen) noexcept {
  const std::span<const double> line_siemens = seen.sums.driven_siemens();
  std::copy(seen.conductance.siemens.begin(), seen.conductance.siemens.end(), last_siemens_.begin());
  std::copy(line_siemens.begin(), line_siemens.end(), last_line_siemens_.begin());
}

}  // namespace dermis::touch::compensation
