// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/supplied_row_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "compensation/faults/page_test.hpp"

namespace dermis::compensation {
namespace {

constexpr LineFaultKind kKind = LineFaultKind::supplied_row;
constexpr int kShowingPresses = 3;
constexpr std::size_t kAlikeReadings = 12;  // few rows may be alike by chance: they need more presses
constexpr double kMostTolerance = 0.2;      // of a reading: beyond, equality means nothing

}  // namespace

SuppliedRowDetector::SuppliedRowDetector(const ArrayDescription& array) : array_(array) {}

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
  if (2 * alike_ < kAlikeReadings || faults.contains(kKind)) return;
  suspicions.push_back({.kind = kKind, .place = candidate_, .frame = count_.first_frame, .time = count_.first_time});
}

/// The row that reads the least, once another one stands out of it.
void SuppliedRowDetector::choose_candidate(const Observation& seen, const FaultList& faults) noexcept {
  const std::span<const double> sum = seen.sums.ratio(Axis::row);
  std::size_t least = 0;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (!faults.contains(LineFaultKind::silent_row, row) && sum[row] < sum[least]) least = row;
  }
  const double noise = seen.conditioned.sigma_ratio * std::sqrt(static_cast<double>(array_.cols));
  if (sum[candidate_] > sum[least] + kDifferentSigmas * noise) {
    candidate_ = least;
    forget_presses();
  }
}

void SuppliedRowDetector::judge_row(const Observation& seen, std::size_t row, bool is_known,
                                    FaultList& faults) noexcept {
  const auto [place, alike, fails] = compare_row(seen, row, faults);
  if (is_known) {
    if (place && fails == 0) count_.against = 0;
    if (fails == 0 || ++count_.against < kLineFrames) return;
    faults.remove(kKind, row);
    forget_presses();
  } else if (fails > 0) {
    forget_presses();
  } else {
    count_.follow(array_.cols, [&](std::size_t col) { return seen.is_pressed(array_.index(row, col)); });
    if (!place || !another_row_is_pressed(seen, row, faults)) return;
    const int presses = count_.presses;
    count_.add(*place, seen.frame, seen.conditioned.time);
    if (count_.presses > presses) alike_ += alike;
    if (alike_ < kAlikeReadings || !count_.decides(kShowingPresses)) return;
    faults.add({.kind = kKind, .place = row, .frame = count_.first_frame, .time = count_.first_time});
  }
}

void SuppliedRowDetector::forget_presses() noexcept {
  count_ = PressCount();
  alike_ = 0;
}

SuppliedRowDetector::Comparison SuppliedRowDetector::compare_row(const Observation& seen, std::size_t row,
                                                                 const FaultList& faults) const noexcept {
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
    if (!press.shows || press.alike < found.alike) continue;
    found.place = col;
    found.alike = press.alike;
  }
  if (pressed == judged) found.place.reset();
  return found;
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
    if (more < -kEqualSigmas * deviation) is_least = false;
    if (more < -kDifferentSigmas * deviation) ++found.fails;
  }
  found.shows = is_least && 2 * found.alike >= others && others >= 2;
  return found;
}

/// A press on another row stands out of what this row shows in its column, or may have shown below a threshold.
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

}  // namespace dermis::compensation
