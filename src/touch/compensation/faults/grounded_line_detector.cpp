// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/grounded_line_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "dermis/touch/frames/neighbours.hpp"
#include "touch/compensation/faults/page_test.hpp"
#include "touch/compensation/faults/untouched.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kDoubtOfEstimate = 0.5;  // relative, of a conductance between neighbours
constexpr double kGroundEvidence = 10.0;
constexpr double kMostEvidence = 3.0;  // of one taxel in one frame

bool is_silent(const LineFault& fault) {
  return traits_of(fault.kind).effect == LineFaultEffect::silent;
}

bool is_dead(const LineFault& fault) {
  return fault.kind == LineFaultKind::dead_taxel;
}

bool is_judged(const LineFault& fault) {
  return is_silent(fault) || is_dead(fault);
}

}  // namespace

GroundedLineDetector::GroundedLineDetector(const ArrayDescription& array)
    : array_(array), untouched_(array.taxel_count()) {}

void GroundedLineDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  if (!seen.solved || !knows_what_currents_take(array_.readout)) return;
  const std::span<LineFault> all = faults.all();
  if (std::none_of(all.begin(), all.end(), is_judged)) return;
  find_untouched(seen, faults);
  for (LineFault& fault : all) {
    if (is_dead(fault)) judge_taxel(seen, fault);
    if (!is_silent(fault)) continue;
    const bool was_grounded = fault.grounded;
    judge_line(seen, fault);
    if (fault.grounded != was_grounded) faults.count_change();
  }
  const auto stuck = std::find_if(all.begin(), all.end(), [](const LineFault& fault) {
    return is_dead(fault) && fault.ground_evidence > kGroundEvidence;
  });
  if (stuck == all.end()) return;
  const LineFault found{
      .kind = LineFaultKind::stuck_taxel, .place = stuck->place, .frame = stuck->frame, .time = stuck->time};
  faults.remove(LineFaultKind::dead_taxel, found.place);
  faults.add(found);
}

/// Taxels that nothing touches, for comparison: none nearby reads more than an unloaded one.
void GroundedLineDetector::find_untouched(const Observation& seen, const FaultList& faults) noexcept {
  const std::span<const double> unloaded_siemens = seen.unloaded.siemens();
  for (std::size_t taxel = 0; taxel < untouched_.size(); ++taxel) {
    untouched_[taxel] = faults.causes(taxel) == 0 && unloaded_siemens[taxel] > 0.0 ? 1 : 0;
  }
  touch_around_presses(seen);
  double siemens = 0.0;
  double unloaded = 0.0;
  for (std::size_t taxel = 0; taxel < untouched_.size(); ++taxel) {
    if (untouched_[taxel] == 0) continue;
    siemens += seen.conductance.siemens[taxel];
    unloaded += unloaded_siemens[taxel];
  }
  common_share_ = unloaded > 0.0 ? siemens / unloaded : 0.0;
}

void GroundedLineDetector::touch_around_presses(const Observation& seen) noexcept {
  PerAxis<std::size_t> reach{.row = kContactReach, .column = kContactReach};
  reach[driven_axis(array_)] = 1;
  for (std::size_t taxel = 0; taxel < untouched_.size(); ++taxel) {
    const double most = seen.unloaded.most_siemens(taxel, seen.conductance.sigma_siemens[taxel]);
    if (seen.conductance.siemens[taxel] <= most) continue;
    for (const std::size_t near : Neighbours(array_.rows, array_.cols, taxel, reach)) untouched_[near] = 0;
  }
}

void GroundedLineDetector::judge_line(const Observation& seen, LineFault& fault) const noexcept {
  for (std::size_t place = 0; place < line_length(array_, *traits_of(fault.kind).axis); ++place) {
    fault.ground_evidence += evidence_at(seen, fault, place);
  }
  fault.ground_evidence = std::clamp(fault.ground_evidence, -kEvidence, kEvidence);
  fault.grounded = fault.ground_evidence > (fault.grounded ? -kGroundEvidence : kGroundEvidence);
}

/// Judges a taxel in the scan of its own line.
void GroundedLineDetector::judge_taxel(const Observation& seen, LineFault& fault) const noexcept {
  const Axis driven = driven_axis(array_);
  const std::size_t place = driven == Axis::row ? fault.place % array_.cols : fault.place / array_.cols;
  fault.ground_evidence += evidence_of_current(seen, driven, place, siemens_between(seen, fault.place), false);
  fault.ground_evidence = std::max(fault.ground_evidence, -kEvidence);
}

/// Conductance between those of the taxels on both its sides; 0 where they are not pressed.
double GroundedLineDetector::siemens_between(const Observation& seen, std::size_t taxel) const noexcept {
  const std::size_t row = taxel / array_.cols;
  const std::size_t col = taxel % array_.cols;
  const auto between = [&](std::size_t before, std::size_t after) {
    if (!seen.is_pressed(before) || !seen.is_pressed(after)) return 0.0;
    return std::sqrt(seen.conductance.siemens[before] * seen.conductance.siemens[after]);
  };
  const bool has_sides = col > 0 && col + 1 < array_.cols;
  const bool has_ends = row > 0 && row + 1 < array_.rows;
  return std::max(has_sides ? between(taxel - 1, taxel + 1) : 0.0,
                  has_ends ? between(taxel - array_.cols, taxel + array_.cols) : 0.0);
}

/// Judges the line that crosses the silent one there: the loss of its untouched taxels against the loss by a short.
double GroundedLineDetector::evidence_at(const Observation& seen, const LineFault& fault,
                                         std::size_t place) const noexcept {
  const Axis axis = *traits_of(fault.kind).axis;
  const std::size_t taxel = taxel_on_line(array_, axis, fault.place, place);
  const double unloaded_siemens = seen.unloaded.siemens()[taxel];
  const double pressed_siemens = seen.conductance.siemens[taxel] - common_share_ * unloaded_siemens;
  if (pressed_siemens < kTouchedShare * unloaded_siemens) return 0.0;
  return evidence_of_current(seen, axis, place, pressed_siemens, fault.grounded);
}

double GroundedLineDetector::evidence_of_current(const Observation& seen, Axis axis, std::size_t place, double siemens,
                                                 bool is_solved) const noexcept {
  const Sums untouched = sums_on(seen, crossing(axis), place);
  const double difference = taken_share(seen, axis, place, siemens) * untouched.expected;
  const double doubt = kDoubtOfEstimate * difference;
  const double variance = untouched.variance + doubt * doubt;
  if (!(variance > 0.0)) return 0.0;
  const double missing = untouched.expected - untouched.siemens + (is_solved ? difference : 0.0);
  return std::clamp(difference * (missing - 0.5 * difference) / variance, -kMostEvidence, kMostEvidence);
}

/// The share that a short of the line would take from the untouched taxels of the line that crosses it at `place`.
double GroundedLineDetector::taken_share(const Observation& seen, Axis axis, std::size_t place,
                                         double pressed_siemens) const noexcept {
  if (axis != driven_axis(array_)) {
    const double drive_ohm = array_.readout.drive_ohm[place];
    return drive_ohm * pressed_siemens / (1.0 + drive_ohm * seen.sums.driven_siemens()[place]);
  }
  if (array_.readout.circuit == Circuit::transimpedance) return 0.0;
  double crossing_siemens = 1.0 / array_.readout.load_ohm[place] + pressed_siemens;
  for (std::size_t line = 0; line < line_count(array_, axis); ++line) {
    crossing_siemens += seen.conductance.siemens[taxel_on_line(array_, axis, line, place)];
  }
  return pressed_siemens / crossing_siemens;
}

GroundedLineDetector::Sums GroundedLineDetector::sums_on(const Observation& seen, Axis axis,
                                                         std::size_t line) const noexcept {
  Sums sums;
  for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
    const std::size_t taxel = taxel_on_line(array_, axis, line, k);
    if (untouched_[taxel] == 0) continue;
    sums.siemens += seen.conductance.siemens[taxel];
    sums.expected += common_share_ * seen.unloaded.siemens()[taxel];
    sums.variance += seen.conductance.sigma_siemens[taxel] * seen.conductance.sigma_siemens[taxel];
  }
  return sums;
}

}  // namespace dermis::touch::compensation
