// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/shorted_line_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "touch/compensation/faults/page_test.hpp"
#include "touch/compensation/lumped_circuit.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kEvidenceOfPress = 3.0;    // of one place; 6 presses decide
constexpr double kMostOfOtherPlaces = 6.0;  // 2 presses, at least
constexpr double kCompressed = 0.7;         // of full scale: hard presses read the same
constexpr double kAlikeSums = 0.05;         // difference of the readings of two lines that may be shorted
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

ShortedLineDetector::ShortedLineDetector(const ArrayDescription& array, EqualPresses& equal_presses)
    : array_(array), equal_presses_(equal_presses) {
  if (array.readout.circuit == Circuit::none) return;
  for (const Axis axis : kAxes) {
    if (line_count(array, axis) < kLeastLines) continue;
    for (std::size_t line = 0; line + 1 < line_count(array, axis); ++line) {
      pairs_[axis].push_back({.ratio = ratio_of_shorted_lines(array, axis, line)});
    }
  }
}

void ShortedLineDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  for (const Axis axis : kAxes) judge_lines(seen, axis, faults);
}

void ShortedLineDetector::suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const {
  for (const Axis axis : kAxes) {
    for (std::size_t line = 0; line < pairs_[axis].size(); ++line) {
      const PressCount& count = pairs_[axis][line].count;
      if (!count.is_suspicious() || faults.contains(kShorted[axis], line)) continue;
      suspicions.push_back(
          {.kind = kShorted[axis], .place = line, .frame = count.first_frame, .time = count.first_time});
    }
  }
}

void ShortedLineDetector::judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept {
  // A line at the supply makes the readings of others alike.
  if (faults.contains(LineFaultKind::supplied_row) || faults.contains(LineFaultKind::supplied_column)) return;
  const bool any_known = faults.contains(kShorted[axis]);
  const std::span<const Pair> pairs = pairs_[axis];
  for (std::size_t line = 0; line < pairs.size(); ++line) {
    const bool is_suspect = pairs[line].count.evidence > 0.0 || (any_known && faults.contains(kShorted[axis], line));
    const bool is_seen = is_suspect || (sums_are_alike(seen, axis, line) && is_pressed(seen, axis, line));
    if (is_seen) judge_pair(seen, axis, line, faults);
  }
}

bool ShortedLineDetector::sums_are_alike(const Observation& seen, Axis axis, std::size_t line) const noexcept {
  const std::span<const double> sums = seen.sums.ratio(axis);
  const double second = pairs_[axis][line].ratio * sums[line + 1];
  const double difference = std::abs(sums[line] - second);
  if (difference > kAlikeSums * sums[line]) return false;
  return sums[line] > kComparedSigmas * seen.conditioned.sigma_ratio;
}

/// The lines are pressed at some place: elsewhere equality means nothing.
bool ShortedLineDetector::is_pressed(const Observation& seen, Axis axis, std::size_t line) const noexcept {
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    if (seen.is_pressed(taxel_on_line(array_, axis, line, place))) return true;
  }
  return false;
}

void ShortedLineDetector::judge_pair(const Observation& seen, Axis axis, std::size_t line, FaultList& faults) noexcept {
  Pair& pair = pairs_[axis][line];
  PressCount& count = pair.count;
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
    return;
  }
  PressComparison beside;
  if (equal_place) beside = compare_beside(seen, axis, line, *equal_place, faults);
  if (different) {
    count = PressCount();
  } else if (equal_place) {
    const double others = equal_presses_.without(pair.learned).evidence(beside.equal);
    count.add(*equal_place, kEvidenceOfPress + std::min(others, kMostOfOtherPlaces), seen.frame, seen.conditioned.time);
    if (count.decides()) {
      faults.add({.kind = kShorted[axis], .place = line, .frame = count.first_frame, .time = count.first_time});
      forget(pair);
      return;
    }
  }
  if (equal_place) learn(seen, axis, line, *equal_place, beside);
}

/// A press that lasts is learned from once, however wide it is and wherever its hardest place wanders.
void ShortedLineDetector::learn(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                const PressComparison& press) noexcept {
  Pair& pair = pairs_[axis][line];
  const std::optional<std::size_t> last = pair.learned_place;
  pair.learned_place = place;
  if (last && are_joined(seen, axis, line, *last, place)) return;
  pair.learned.add(press);
  equal_presses_.add(press);
}

/// All places between them are pressed, but those that a press may have slid from since the last frame.
bool ShortedLineDetector::are_joined(const Observation& seen, Axis axis, std::size_t line, std::size_t a,
                                     std::size_t b) const noexcept {
  const auto [from, to] = std::minmax(a, b);
  for (std::size_t place = from + kSlide; place + kSlide < to + 1; ++place) {
    if (!seen.is_pressed(taxel_on_line(array_, axis, line, place))) return false;
  }
  return true;
}

/// Presses that a short made equal are no evidence on healthy lines.
void ShortedLineDetector::forget(Pair& pair) noexcept {
  equal_presses_ = equal_presses_.without(pair.learned);
  pair.learned = EqualPresses();
  pair.learned_place.reset();
}

ShortedLineDetector::PlaceComparison ShortedLineDetector::compare_at(const Observation& seen, Axis axis,
                                                                     std::size_t line, std::size_t place,
                                                                     const FaultList& faults) const noexcept {
  const std::size_t first = taxel_on_line(array_, axis, line, place);
  const std::size_t second = taxel_on_line(array_, axis, line + 1, place);
  const int spoilt = kLineCause[axis] | kStuckCause | kDeadCause;
  const std::span<const TaxelStatus> status = seen.conditioned.taxels;
  if (((faults.causes(first) | faults.causes(second)) & spoilt) != 0) return {};
  if (status[first] != TaxelStatus::ok || status[second] != TaxelStatus::ok) return {};
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double sigma = seen.conditioned.sigma_ratio;
  const double pair = pairs_[axis][line].ratio;
  const double largest = std::max(ratio[first], ratio[second]);
  const double deviation = std::sqrt((1.0 + pair * pair) * sigma * sigma + square(kEqualShare * largest));
  return {.is_judged = true,
          .largest = largest,
          .deviation = deviation,
          .difference = (ratio[first] - pair * ratio[second]) / deviation};
}

ShortedLineDetector::Comparison ShortedLineDetector::compare_with_next(const Observation& seen, Axis axis,
                                                                       std::size_t line,
                                                                       const FaultList& faults) const noexcept {
  Comparison found;
  double squares = 0.0;
  double taxels = 0.0;
  double hardest = kComparedSigmas * seen.conditioned.sigma_ratio;
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const PlaceComparison at = compare_at(seen, axis, line, place, faults);
    if (!at.is_judged) continue;
    squares += square(at.difference);
    taxels += 1.0;
    if (std::abs(at.difference) > kEqualSigmas || at.largest < hardest) continue;
    if (!seen.is_pressed(taxel_on_line(array_, axis, line, place))) continue;
    if (!stands_out(seen, axis, line, place, at.deviation, faults)) continue;
    hardest = at.largest;
    found.equal_place = place;
  }
  found.different = squares > most_by_noise(taxels);
  return found;
}

/// The other places where the lines are pressed. Those that read the same as this one do not count: a readout may end
/// there.
PressComparison ShortedLineDetector::compare_beside(const Observation& seen, Axis axis, std::size_t line,
                                                    std::size_t place, const FaultList& faults) const noexcept {
  const PlaceComparison hardest = compare_at(seen, axis, line, place, faults);
  PressComparison press;
  for (std::size_t other = 0; other < line_length(array_, axis); ++other) {
    const PlaceComparison at = compare_at(seen, axis, line, other, faults);
    if (!at.is_judged || at.largest < kComparedSigmas * seen.conditioned.sigma_ratio || at.largest > kCompressed) {
      continue;
    }
    if (std::abs(at.largest - hardest.largest) <= kDifferentSigmas * at.deviation) continue;
    if (!seen.is_pressed(taxel_on_line(array_, axis, line, other))) continue;
    if (std::abs(at.difference) <= kEqualSigmas) {
      ++press.equal;
    } else {
      ++(at.difference > 0.0 ? press.more : press.less);
    }
  }
  return press;
}

/// The pair reads differently there from the lines beside it, and much more than one of them: presses end there. Lines
/// that are alike everywhere may be shorted to the pair.
bool ShortedLineDetector::stands_out(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                     double deviation, const FaultList& faults) const noexcept {
  const std::span<const double> ratio = seen.conditioned.ratio;
  const double own = ratio[taxel_on_line(array_, axis, line, place)];
  const auto is_same = [&](std::size_t other) {
    return std::abs(ratio[taxel_on_line(array_, axis, other, place)] - own) <= kDifferentSigmas * deviation;
  };
  std::size_t first = line;
  std::size_t last = line + 1;
  while (first > 0 && is_same(first - 1) && are_alike(seen, axis, first - 1, faults)) --first;
  while (last + 1 < line_count(array_, axis) && is_same(last + 1) && are_alike(seen, axis, last, faults)) ++last;
  bool is_alone = false;
  for (const std::size_t beside : {first - 1, last + 1}) {  // line 0 has none before it: wraps round to the largest
    if (beside >= line_count(array_, axis)) continue;
    if (is_same(beside)) return false;
    is_alone = is_alone || kStandsOut * ratio[taxel_on_line(array_, axis, beside, place)] < own;
  }
  return is_alone;
}

/// The line and the next one differ by no more than noise, all along.
bool ShortedLineDetector::are_alike(const Observation& seen, Axis axis, std::size_t line,
                                    const FaultList& faults) const noexcept {
  double squares = 0.0;
  double taxels = 0.0;
  for (std::size_t place = 0; place < line_length(array_, axis); ++place) {
    const PlaceComparison at = compare_at(seen, axis, line, place, faults);
    squares += at.is_judged ? square(at.difference) : 0.0;
    taxels += at.is_judged ? 1.0 : 0.0;
  }
  return taxels > 0.0 && squares <= most_by_noise(taxels);
}

}  // namespace dermis::touch::compensation
