// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/supplied_row_detector.hpp"

#include <cmath>
#include <span>

#include "compensation/faults/page_test.hpp"

namespace dermis::compensation {
namespace {

constexpr LineFaultKind kKind = LineFaultKind::supplied_row;
constexpr int kShowingPresses = 6;

}  // namespace

SuppliedRowDetector::SuppliedRowDetector(const ArrayDescription& array)
    : array_(array), last_ratio_(array.taxel_count()) {}

void SuppliedRowDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  if (array_.readout.circuit == Circuit::flexitac || array_.rows < 3) return;
  if (faults.contains(LineFaultKind::supplied_column)) return;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    if (faults.contains(kKind, row)) return judge_row(seen, row, true, faults);
  }
  choose_candidate(seen, faults);
  judge_row(seen, candidate_, false, faults);
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
    count_ = PressCount();
  }
}

void SuppliedRowDetector::judge_row(const Observation& seen, std::size_t row, bool is_known,
                                    FaultList& faults) noexcept {
  const Comparison compared = compare_row(seen, row, faults);
  count_.against = compared.fails > 0 ? count_.against + 1 : (compared.any ? 0 : count_.against);
  if (is_known) {
    if (count_.against < kLineFrames) return;
    faults.remove(kKind, row);
    count_ = PressCount();
    return;
  }
  if (compared.fails > 0) count_.presses = 0;
  count_.add(compared.shows, seen.frame, seen.conditioned.time);
  if (count_.presses < kShowingPresses) return;
  faults.add({.kind = kKind, .place = row, .frame = count_.first_frame, .time = count_.first_time});
  count_.against = 0;
}

SuppliedRowDetector::Comparison SuppliedRowDetector::compare_row(const Observation& seen, std::size_t row,
                                                                 const FaultList& faults) noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double sigma = seen.conditioned.sigma_ratio;
  Comparison found;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const std::size_t own = array_.index(row, col);
    if ((faults.causes(own) & ~kRowCause) != 0 || seen.conditioned.taxels[own] != TaxelStatus::ok) continue;
    if (ratio[own] < kPressedSigmas * sigma + kTouchedShare * seen.unloaded.ratio()[own]) continue;
    const ColumnComparison press = compare_in_column(seen, row, col, faults);
    found.fails += press.fails;
    if (!press.shows) continue;
    found.any = true;
    if (std::abs(ratio[own] - last_ratio_[own]) < kNewPress * ratio[own]) continue;
    last_ratio_[own] = ratio[own];
    ++found.shows;
  }
  return found;
}

SuppliedRowDetector::ColumnComparison SuppliedRowDetector::compare_in_column(const Observation& seen, std::size_t row,
                                                                             std::size_t col,
                                                                             const FaultList& faults) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double sigma = seen.conditioned.sigma_ratio;
  const std::size_t own = array_.index(row, col);
  const double deviation = std::hypot(sigma, sigma, kEqualShare * ratio[own]);
  std::size_t others = 0;
  std::size_t alike = 0;
  bool is_least = true;
  ColumnComparison found;
  for (std::size_t other = 0; other < array_.rows; ++other) {
    const std::size_t taxel = array_.index(other, col);
    if (other == row || (faults.causes(taxel) & (kRowCause | kStuckCause)) != 0) continue;
    const double more = ratio[taxel] - ratio[own];
    ++others;
    if (more < kTouchedShare * seen.unloaded.ratio()[taxel] + kEqualSigmas * deviation) ++alike;
    if (more < -kEqualSigmas * deviation) is_least = false;
    if (more < -kDifferentSigmas * deviation) ++found.fails;
  }
  found.shows = is_least && 2 * alike >= others && others >= 2;
  return found;
}

}  // namespace dermis::compensation
