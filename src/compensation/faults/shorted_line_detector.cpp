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

constexpr int kEqualPresses = 6;
constexpr double kAlikeSums = 0.05;  // difference of the readings of two lines that may be shorted
constexpr std::size_t kLeastLines = 3;

constexpr PerAxis<LineFaultKind> kShorted{.row = LineFaultKind::shorted_rows, .column = LineFaultKind::shorted_columns};

double square(double value) {
  return value * value;
}

/// Most that so many squares of standard normal deviations sum up to.
double most_by_noise(double count) {
  return count + kDifferentSigmas * std::sqrt(2.0 * count);
}

}  // namespace

ShortedLineDetector::ShortedLineDetector(const ArrayDescription& array) : array_(array) {
  if (array.readout.circuit == Circuit::none) return;
  for (const Axis axis : kAxes) {
    if (line_count(array, axis) >= kLeastLines) counts_[axis].resize(line_count(array, axis) - 1);
  }
}

void ShortedLineDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  for (const Axis axis : kAxes) judge_lines(seen, axis, faults);
}

void ShortedLineDetector::suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const {
  for (const Axis axis : kAxes) {
    for (std::size_t line = 0; line < counts_[axis].size(); ++line) {
      const PressCount& count = counts_[axis][line];
      if (2 * count.presses < kEqualPresses || faults.contains(kShorted[axis], line)) continue;
      suspicions.push_back(
          {.kind = kShorted[axis], .place = line, .frame = count.first_frame, .time = count.first_time});
    }
  }
}

void ShortedLineDetector::judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept {
  // A line at the supply makes the readings of others alike.
  if (faults.contains(LineFaultKind::supplied_row) || faults.contains(LineFaultKind::supplied_column)) return;
  const bool any_known = faults.contains(kShorted[axis]);
  const std::span<const PressCount> counts = counts_[axis];
  for (std::size_t line = 0; line < counts.size(); ++line) {
    const bool is_suspect = counts[line].presses > 0 || (any_known && faults.contains(kShorted[axis], line));
    if (is_suspect || sums_are_alike(seen, axis, line)) judge_pair(seen, axis, line, faults);
  }
}

bool ShortedLineDetector::sums_are_alike(const Observation& seen, Axis axis, std::size_t line) const noexcept {
  const std::span<const double> sums = seen.sums.ratio(axis);
  const double second = ratio_of_shorted_lines(array_, axis, line) * sums[line + 1];
  const double difference = std::abs(sums[line] - second);
  if (difference > kAlikeSums * sums[line]) return false;
  return sums[line] > kComparedSigmas * seen.conditioned.sigma_ratio;
}

void ShortedLineDetector::judge_pair(const Observation& seen, Axis axis, std::size_t line, FaultList& faults) noexcept {
  PressCount& count = counts_[axis][line];
  count.follow(line_length(array_, axis), [&](std::size_t place) {
    return seen.is_pressed(taxel_on_line(array_, axis, line, place)) ||
           seen.is_pressed(taxel_on_line(array_, axis, line + 1, place));
  });
  const auto [different, equal_place] = compare_with_next(seen, axis, line, faults);
  if (faults.contains(kShorted[axis], line)) {
    if (equal_place && !different) count.against = 0;
    if (!different || ++count.against < kLineFrames) return;
    faults.remove(kShorted[axis], line);
    count = PressCount();
  } else if (different) {
    count = PressCount();
  } else if (equal_place) {
    count.add(*equal_place, seen.frame, seen.conditioned.time);
    if (!count.decides(kEqualPresses)) return;
    faults.add({.kind = kShorted[axis], .place = line, .frame = count.first_frame, .time = count.first_time});
  }
}

ShortedLineDetector::Comparison ShortedLineDetector::compare_with_next(const Observation& seen, Axis axis,
                                                                       std::size_t line,
                                                                       const FaultList& faults) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const std::span<const TaxelStatus> status = seen.conditioned.taxels;
  const double sigma = seen.conditioned.sigma_ratio;
  const double pair = ratio_of_shorted_lines(array_, axis, line);
  const int spoilt = kLineCause[axis] | kStuckCause | kDeadCause;
  const double most_squares = most_by_noise(static_cast<double>(line_length(array_, axis)));
  Comparison found;
  double squares = 0.0;
  double taxels = 0.0;
  double hardest = kComparedSigmas * sigma;
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const std::size_t first = taxel_on_line(array_, axis, line, place);
    const std::size_t second = taxel_on_line(array_, axis, line + 1, place);
    if (((faults.causes(first) | faults.causes(second)) & spoilt) != 0) continue;
    if (status[first] != TaxelStatus::ok || status[second] != TaxelStatus::ok) continue;
    const double largest = std::max(ratio[first], ratio[second]);
    const double variance = (1.0 + pair * pair) * sigma * sigma + square(kEqualShare * largest);
    const double deviation_square = square(ratio[first] - pair * ratio[second]) / variance;
    squares += deviation_square;
    taxels += 1.0;
    if (squares > most_squares) return {.different = true, .equal_place = std::nullopt};
    if (deviation_square > square(kEqualSigmas) || largest < hardest || !seen.is_pressed(first)) continue;
    if (!stands_out(seen, axis, line, place, std::sqrt(variance))) continue;
    hardest = largest;
    found.equal_place = place;
  }
  found.different = squares > most_by_noise(taxels);
  return found;
}

/// The pair reads something else there than the lines beside it, and much more than one of them: presses end there.
bool ShortedLineDetector::stands_out(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                     double deviation) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double own = ratio[taxel_on_line(array_, axis, line, place)];
  bool is_alone = false;
  for (const std::size_t beside : {line - 1, line + 2}) {  // line 0 has none before it: wraps round to the largest
    if (beside >= line_count(array_, axis)) continue;
    const double other = ratio[taxel_on_line(array_, axis, beside, place)];
    if (std::abs(other - own) <= kDifferentSigmas * deviation) return false;
    is_alone = is_alone || kStandsOut * other < own;
  }
  return is_alone;
}

}  // namespace dermis::compensation
