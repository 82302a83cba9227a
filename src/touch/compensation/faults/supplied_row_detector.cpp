// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/supplied_row_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "touch/compensation/faults/page_test.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr LineFaultKind kKind = LineFaultKind::supplied_row;
constexpr double kEvidenceOfReading = 1.5;       // that is alike: few rows may be by chance, and need more presses
constexpr double kMostOfPress = 6.0;             // where taxels may all be the same: 3 presses decide
constexpr double kMostWhereTaxelsScatter = 9.0;  // 2 presses decide
constexpr int kDecisiveFrames = 2;               // one bad frame is none
constexpr double kBelow = 1.3;                   // times the readings of the row are those of all others
constexpr double kGhostShare = 0.1;              // of the press that makes it
constexpr double kMostTolerance = 0.2;           // of a reading: beyond, equality means nothing
constexpr double kCloseTolerance = 0.12;  // as equal as the places of a press are taken to be; full scale makes equal

}  // namespace

SuppliedRowDetector::SuppliedRowDetector(const ArrayDescription& array, const EqualPresses& equal_presses)
    : array_(array), equal_presses_(equal_presses) {}

void SuppliedRowDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  const Circuit circuit = array_.readout.circuit;
  if (circuit == Circuit::flexitac || circuit == Circuit::none || array_.rows < 3) return;
  if (faults.contains(LineFaultKind::supplied_column)) return;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (faults.contains(kKind, row)) return judge_row(seen, row, true, faults);
  }
  choose_candidate(seen, faults);
  judge_row(seen, candidate_, false, faults);
}

void SuppliedRowDetector::suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const {
  if (!count_.is_suspicious() || faults.contains(kKind)) return;
  suspicions.push_back({.kind = kKind, .place = candidate_, .frame = count_.first_frame, .time = count_.first_time});
}

/// The row that reads the least, once another one stands out of it.
void SuppliedRowDetector::choose_candidate(const Observation& seen, const FaultList& faults) noexcept {
  const std::span<const double> sum = seen.sums.ratio(Axis::row);
  const auto is_silent = [&](std::size_t row) { return faults.contains(LineFaultKind::silent_row, row); };
  std::optional<std::size_t> least;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (!is_silent(row) && (!least || sum[row] < sum[*least])) least = row;
  }
  if (!least) return;
  const double noise = seen.conditioned.sigma_ratio * std::sqrt(static_cast<double>(array_.cols));
  if (is_silent(candidate_) || sum[candidate_] > sum[*least] + kDifferentSigmas * noise) {
    candidate_ = *least;
    frames_below_ = 0;
    forget_presses();
  }
  follow_rows_below(seen, faults, noise);
}

/// Judges places where the candidate is not pressed: all other rows hold its reading beside their own.
void SuppliedRowDetector::follow_rows_below(const Observation& seen, const FaultList& faults, double noise) noexcept {
  for (std::size_t col = 0; col < array_.cols; ++col) {
    if (seen.is_pressed(array_.index(candidate_, col))) return;
  }
  const std::span<const double> sum = seen.sums.ratio(Axis::row);
  bool is_below = true;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (row == candidate_ || faults.contains(LineFaultKind::silent_row, row)) continue;
    is_below = is_below && sum[row] > kBelow * sum[candidate_] + kEqualSigmas * noise;
  }
  frames_below_ = is_below ? frames_below_ + 1 : 0;
}

void SuppliedRowDetector::judge_row(const Observation& seen, std::size_t row, bool is_known,
                                    FaultList& faults) noexcept {
  const Comparison compared = compare_row(seen, row, faults);
  if (is_known) {
    if (compared.place && compared.fails == 0) count_.against = 0;
    if (compared.fails == 0 || ++count_.against < kLineFrames) return;
    faults.remove(kKind, row);
    forget_presses();
  } else if (compared.fails > 0) {
    forget_presses();
  } else {
    count_.follow(array_.cols, [&](std::size_t col) { return seen.is_pressed(array_.index(row, col)); });
    if (!compared.place || !another_row_is_pressed(seen, row, faults)) return;
    count_.add(*compared.place, evidence_of_press(compared), seen.frame, seen.conditioned.time);
    if (is_decisive(seen, compared)) ++decisive_frames_;
    const bool is_decided = decisive_frames_ >= (frames_below_ >= kLineFrames ? 1 : kDecisiveFrames);
    if (!is_decided && !count_.decides()) return;
    faults.add({.kind = kKind, .place = row, .frame = count_.first_frame, .time = count_.first_time});
  }
}

void SuppliedRowDetector::forget_presses() noexcept {
  count_ = PressCount();
  decisive_frames_ = 0;
}

/// Taxels that scatter are equal at several places with different readings, so the end of the readout is not the cause.
bool SuppliedRowDetector::is_decisive(const Observation& seen, const Comparison& compared) const noexcept {
  const double deviation = std::hypot(seen.conditioned.sigma_ratio, kEqualShare * compared.most);
  return compared.most - compared.least > kDifferentSigmas * deviation &&
         equal_presses_.evidence(static_cast<int>(compared.all_alike)) >= kEvidence;
}

double SuppliedRowDetector::evidence_of_press(const Comparison& compared) const noexcept {
  const double least = std::min(kEvidenceOfReading * static_cast<double>(compared.alike), kMostOfPress);
  const double more = equal_presses_.evidence(static_cast<int>(compared.closely_alike));
  return std::min(least + more, kMostWhereTaxelsScatter);
}

SuppliedRowDetector::Comparison SuppliedRowDetector::compare_row(const Observation& seen, std::size_t row,
                                                                 const FaultList& faults) const noexcept {
  const bool rows_float = array_.readout.idle_rows == IdleRows::floating;
  Comparison found;
  std::size_t judged = 0;
  std::size_t pressed = 0;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const std::size_t own = array_.index(row, col);
    if ((faults.causes(own) & ~kRowCause) != 0 || seen.conditioned.taxels[own] != TaxelStatus::ok) continue;
    ++judged;
    if (!seen.is_pressed(own)) continue;
    ++pressed;
    const ColumnComparison press = compare_in_column(seen, row, col, faults);
    found.fails += press.fails;
    if (!press.shows || (rows_float && is_ghost(seen, own))) continue;
    const double reading = seen.conditioned.ratio[own];
    found.least = found.place ? std::min(found.least, reading) : reading;
    found.most = std::max(found.most, reading);
    found.all_alike += press.closely_alike;
    if (press.alike < found.alike) continue;
    found.closely_alike = press.closely_alike;
    found.place = col;
    found.alike = press.alike;
  }
  if (pressed == judged) found.place.reset();
  return found;
}

/// Where rows float, a press reads on all of them, but conducts far more than they do.
bool SuppliedRowDetector::is_ghost(const Observation& seen, std::size_t taxel) const noexcept {
  double most = 0.0;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    most = std::max(most, seen.conductance.siemens[array_.index(row, taxel % array_.cols)]);
  }
  return !seen.conducts_more(taxel) || seen.conductance.siemens[taxel] < kGhostShare * most;
}

SuppliedRowDetector::ColumnComparison SuppliedRowDetector::compare_in_column(const Observation& seen, std::size_t row,
                                                                             std::size_t col,
                                                                             const FaultList& faults) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double sigma = seen.conditioned.sigma_ratio;
  const double own = ratio[array_.index(row, col)];
  const double deviation = std::hypot(sigma, sigma, kEqualShare * own);
  std::size_t others = 0;
  bool is_least = true;
  ColumnComparison found;
  for (std::size_t other = 0; other < array_.rows; ++other) {
    const std::size_t taxel = array_.index(other, col);
    if (other == row || (faults.causes(taxel) & (kRowCause | kStuckCause)) != 0) continue;
    const double more = ratio[taxel] - own;
    const double tolerance = kEqualSigmas * deviation + seen.unloaded.ratio()[taxel];
    ++others;
    if (more < tolerance && tolerance < kMostTolerance * own) ++found.alike;
    if (more < tolerance && tolerance < kCloseTolerance * own * (1.0 - own)) ++found.closely_alike;
    if (more < -kEqualSigmas * deviation) is_least = false;
    if (more < -kDifferentSigmas * deviation) ++found.fails;
  }
  found.shows = is_least && 2 * found.alike >= others && others >= 2;
  return found;
}

/// A press on another row stands out of this row's readings in its column, or of the most that a threshold may hide.
bool SuppliedRowDetector::another_row_is_pressed(const Observation& seen, std::size_t row,
                                                 const FaultList& faults) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double most_cut_off = kStandsOut * seen.unloaded.smallest_reading();
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    if ((faults.causes(taxel) & (kRowCause | kStuckCause)) != 0 || !seen.is_pressed(taxel)) continue;
    const double own = ratio[array_.index(row, taxel % array_.cols)];
    if (ratio[taxel] > kStandsOut * std::max(own, most_cut_off)) return true;
  }
  return false;
}

}  // namespace dermis::touch::compensation
