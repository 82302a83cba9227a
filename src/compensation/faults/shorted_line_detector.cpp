// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/shorted_line_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "compensation/faults/page_test.hpp"
#include "compensation/lumped_circuit.hpp"

namespace dermis::compensation {
namespace {

constexpr int kEqualPresses = 10;

constexpr PerAxis<LineFaultKind> kShorted{.row = LineFaultKind::shorted_rows, .column = LineFaultKind::shorted_columns};

}  // namespace

ShortedLineDetector::ShortedLineDetector(const ArrayDescription& array) : array_(array) {
  for (const Axis axis : kAxes) {
    lines_[axis].counts.resize(line_count(array, axis) - 1);
    lines_[axis].last_ratio.resize(array.taxel_count());
  }
}

void ShortedLineDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  for (const Axis axis : kAxes) judge_lines(seen, axis, faults);
}

void ShortedLineDetector::judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept {
  // A line at the supply makes the readings of others alike.
  if (faults.contains(LineFaultKind::supplied_row) || faults.contains(LineFaultKind::supplied_column)) return;
  const bool any_known = faults.contains(kShorted[axis]);
  auto& [counts, last_ratio, turn] = lines_[axis];
  if (counts.empty()) return;
  turn = (turn + 1) % counts.size();
  for (std::size_t line = 0; line < counts.size(); ++line) {
    const bool is_suspect = counts[line].presses > 0 || (any_known && faults.contains(kShorted[axis], line));
    if (is_suspect || line == turn) judge_pair(seen, axis, line, faults);
  }
}

void ShortedLineDetector::judge_pair(const Observation& seen, Axis axis, std::size_t line, FaultList& faults) noexcept {
  const Comparison compared = compare_with_next(seen, axis, line, faults);
  PressCount& count = lines_[axis].counts[line];
  if (compared.different > 0) {
    ++count.against;
  } else if (compared.equal > 0) {
    count.against = 0;
  }
  const bool is_known = faults.contains(kShorted[axis], line);
  if (compared.different > 0 && (!is_known || count.against >= kLineFrames)) {
    if (is_known) faults.remove(kShorted[axis], line);
    count.presses = 0;
  } else if (!is_known) {
    count.add(compared.equal, seen.frame, seen.conditioned.time);
    if (count.presses < kEqualPresses) return;
    faults.add({.kind = kShorted[axis], .place = line, .frame = count.first_frame, .time = count.first_time});
    count.against = 0;
  }
}

ShortedLineDetector::Comparison ShortedLineDetector::compare_with_next(const Observation& seen, Axis axis,
                                                                       std::size_t line,
                                                                       const FaultList& faults) noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const std::span<const TaxelStatus> status = seen.conditioned.taxels;
  const double sigma = seen.conditioned.sigma_ratio;
  const double pair = ratio_of_shorted_lines(array_, axis, line);
  const int spoilt = kLineCause[axis] | kStuckCause | kDeadCause;
  Comparison found;
  for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
    const std::size_t first = taxel_on_line(array_, axis, line, k);
    const std::size_t second = taxel_on_line(array_, axis, line + 1, k);
    if (((faults.causes(first) | faults.causes(second)) & spoilt) != 0) continue;
    if (status[first] != TaxelStatus::ok || status[second] != TaxelStatus::ok) continue;
    const double largest = std::max(ratio[first], ratio[second]);
    if (largest < kPressedSigmas * sigma) continue;
    const double deviation = std::hypot(sigma, pair * sigma, kEqualShare * largest);
    const double difference = std::abs(ratio[first] - pair * ratio[second]);
    if (difference > kDifferentSigmas * deviation) ++found.different;
    if (difference > kEqualSigmas * deviation) continue;
    const auto reads_alike = [&](std::size_t other) {
      const std::size_t taxel = taxel_on_line(array_, axis, other, k);
      return std::abs(ratio[taxel] - ratio[first]) <= kDifferentSigmas * deviation;
    };
    if (line > 0 && reads_alike(line - 1)) continue;
    if (line + 2 < line_count(array_, axis) && reads_alike(line + 2)) continue;
    double& last = lines_[axis].last_ratio[first];
    if (std::abs(ratio[first] - last) < kNewPress * largest) continue;
    last = ratio[first];
    ++found.equal;
  }
  return found;
}

}  // namespace dermis::compensation
