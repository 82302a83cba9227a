// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/impossible_reading_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/faults/any_reading.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr int kFrames = 10;
constexpr std::size_t kMostFound = 12;  // in one frame, and at once: more have a cause in common
constexpr std::size_t kMostTaken = 4 * kMostFound;
constexpr double kPerFrame = kEvidence / kFrames;
constexpr double kStillShorted = 0.15;    // of what a taxel of 0 ohm reads alone: where up to six lines are one
constexpr double kMostRepetitions = 0.8;  // of the frames; a reading that repeats more in spite of noise is stuck
constexpr double kNoiseThatShows = 0.7;   // counts; below it good readings repeat, too
constexpr double kSame = 1e-3;            // standard deviations
constexpr double kHigh = 0.5;             // of the supply: a reading that is compared with its column
constexpr double kMostOfColumn = 0.6;     // taxels that read no more than unloaded ones
constexpr double kUnloadedSigmas = 3.0;
constexpr double kMostOfWhole = 0.15;  // by which unloaded taxels of other columns may have changed
constexpr double kColumnSigmas = 4.0;
constexpr double kPerFrameOfColumn = 0.5 * kPerFrame;
constexpr double kSilentShare = 0.5;  // of what the taxels of a row read unloaded
constexpr double kSilentSigmas = 3.0;
constexpr std::size_t kFewestSilent = 3;  // taxels

DERMIS_PROCESSOR_CLONES std::size_t count_taken(std::span<const TaxelStatus> before,
                                                std::span<const TaxelStatus> after) {
  const TaxelStatus* const status = before.data();
  const TaxelStatus* const kept = after.data();
  int taken = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    taken += kept[k] == TaxelStatus::invalid && status[k] != TaxelStatus::invalid ? 1 : 0;
  }
  return static_cast<std::size_t>(taken);
}

bool is_of_faulty_line(const FaultList& faults, std::size_t taxel) {
  return (faults.causes(taxel) & (kRowCause | kColumnCause | kPairCause)) != 0;
}

std::optional<LineFaultKind> found_kind(const FaultList& faults, std::size_t taxel) {
  for (const LineFaultKind kind : {LineFaultKind::shorted_crossing, LineFaultKind::impossible_reading}) {
    if (faults.contains(kind, taxel)) return kind;
  }
  return std::nullopt;
}

}  // namespace

ImpossibleReadingDetector::ImpossibleReadingDetector(const ArrayDescription& array)
    : array_(array),
      possible_(array),
      columns_tell_(array.readout.circuit == Circuit::divider && array.readout.idle_rows == IdleRows::grounded),
      rows_tell_(array.readout.circuit == Circuit::transimpedance && !has_resistive_lines(array.readout)),
      verdicts_(array.taxel_count(), ReadingVerdict::possible) {
  watched_.reserve(kMostFound);
}

void ImpossibleReadingDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  if (array_.readout.circuit == Circuit::none) return;
  watch_new(seen, faults);
  if (columns_tell_) watch_columns(seen, faults);
  if (watched_.empty()) return;
  for (Watched& watched : watched_) {
    const ReadingVerdict now = verdict(seen, watched.taxel);
    const std::optional<LineFaultKind> kind = found_kind(faults, watched.taxel);
    kind ? heal(seen, now, *kind, watched, faults) : find(seen, now, watched, faults);
  }
  std::erase_if(watched_, [&](const Watched& watched) {
    const bool is_suspect = watched.impossible.frames > 0 || watched.shorted.frames > 0;
    const bool is_stuck = faults.contains(LineFaultKind::stuck_taxel, watched.taxel);
    return is_stuck || is_of_faulty_line(faults, watched.taxel) || (!is_suspect && !found_kind(faults, watched.taxel));
  });
  faults.suspect(watched_, [](const Watched& watched) { return watched.taxel; });
}

/// Where the Compensator has taken no reading away, all are possible.
void ImpossibleReadingDetector::watch_new(const Observation& seen, const FaultList& faults) noexcept {
  const auto& before = seen.conditioned.taxels;
  const auto& after = seen.conductance.taxels;
  const auto is_bad = [&](std::size_t taxel) { return verdict(seen, taxel) >= ReadingVerdict::shorted; };
  if (std::exchange(any_verdict_, false)) std::fill(verdicts_.begin(), verdicts_.end(), ReadingVerdict::possible);
  if (watched_.empty() && !any_is_suspicious(before, after)) return doubt_taken(before, after);
  any_verdict_ = true;
  possible_.judge(seen.conditioned.ratio, seen.conditioned.sigma_ratio, before, verdicts_);
  std::size_t bad = 0;
  for (std::size_t taxel = 0; taxel < before.size(); ++taxel) bad += is_bad(taxel) ? 1 : 0;
  if (bad > kMostFound) return;
  for (std::size_t taxel = 0; taxel < before.size(); ++taxel) {
    if (is_bad(taxel)) watch(taxel, faults);
  }
}

/// Some readings were taken away, or are at the end of the ADC where that tells something. A row that was taken away
/// whole has no names for its taxels, and so many have a cause in common.
bool ImpossibleReadingDetector::any_is_suspicious(std::span<const TaxelStatus> before,
                                                  std::span<const TaxelStatus> after) const noexcept {
  const std::size_t cols = array_.cols;
  std::size_t suspicious = 0;
  for (std::size_t first = 0; first < before.size(); first += cols) {
    const std::size_t taken = count_taken(before.subspan(first, cols), after.subspan(first, cols));
    if (taken < cols) suspicious += taken;
  }
  if (suspicious > kMostTaken) return false;
  return suspicious > 0 ||
         (rows_tell_ && std::find(before.begin(), before.end(), TaxelStatus::saturated) != before.end());
}

void ImpossibleReadingDetector::doubt_taken(std::span<const TaxelStatus> before,
                                            std::span<const TaxelStatus> after) noexcept {
  if (count_taken(before, after) == 0) return;
  any_verdict_ = true;
  for (std::size_t taxel = 0; taxel < before.size(); ++taxel) {
    const bool is_taken = after[taxel] == TaxelStatus::invalid && before[taxel] != TaxelStatus::invalid;
    if (is_taken) verdicts_[taxel] = ReadingVerdict::unknown;
  }
}

void ImpossibleReadingDetector::watch_columns(const Observation& seen, const FaultList& faults) noexcept {
  if (!any_is_above(seen.conditioned.ratio, kHigh)) return;
  std::array<std::size_t, kMostFound> found{};
  std::size_t count = 0;
  for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
    if (seen.conditioned.ratio[taxel] < kHigh || verdict(seen, taxel) != ReadingVerdict::impossible) continue;
    if (count == kMostFound) return;
    found[count++] = taxel;
  }
  for (std::size_t k = 0; k < count; ++k) watch(found[k], faults);
}

/// Judges a high reading; `possible` where the others of its column have fallen.
ReadingVerdict ImpossibleReadingDetector::verdict_of_column(const Observation& seen, std::size_t taxel) const noexcept {
  const double ratio = seen.conditioned.ratio[taxel];
  if (ratio < kHigh) return ReadingVerdict::possible;
  double unloaded = 0.0;
  double read = 0.0;
  double count = 0.0;
  for (std::size_t other = taxel % array_.cols; other < array_.taxel_count(); other += array_.cols) {
    const double expected = seen.unloaded.ratio()[other];
    const bool is_unloaded = seen.conditioned.ratio[other] <= expected + kUnloadedSigmas * seen.conditioned.sigma_ratio;
    if (other == taxel || !is_unloaded) continue;
    unloaded += expected;
    read += seen.conditioned.ratio[other];
    count += 1.0;
  }
  const double fall = 0.5 * ratio * unloaded;
  const bool can_tell = others_are_unloaded(seen, taxel % array_.cols) &&
                        count >= kMostOfColumn * static_cast<double>(array_.rows - 1) &&
                        fall > kColumnSigmas * seen.conditioned.sigma_ratio * std::sqrt(count);
  if (!can_tell) return ReadingVerdict::unknown;
  return read > unloaded - fall ? ReadingVerdict::impossible : ReadingVerdict::possible;
}

/// Most taxels of the other columns read as calibrated, and so do those together. Otherwise the whole array has
/// changed.
bool ImpossibleReadingDetector::others_are_unloaded(const Observation& seen, std::size_t col) const noexcept {
  double unloaded = 0.0;
  double read = 0.0;
  std::size_t count = 0;
  for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
    const double expected = seen.unloaded.ratio()[taxel];
    const double change = std::abs(seen.conditioned.ratio[taxel] - expected);
    if (taxel % array_.cols == col || change > kUnloadedSigmas * seen.conditioned.sigma_ratio) continue;
    unloaded += expected;
    read += seen.conditioned.ratio[taxel];
    ++count;
  }
  const bool are_most = 2 * count > array_.taxel_count() - array_.rows;
  return are_most && std::abs(read - unloaded) < kMostOfWhole * unloaded;
}

/// Judges a reading unless its line explains it.
void ImpossibleReadingDetector::watch(std::size_t taxel, const FaultList& faults) noexcept {
  const auto is_same = [taxel](const Watched& watched) { return watched.taxel == taxel; };
  if (watched_.size() == kMostFound || is_of_faulty_line(faults, taxel)) return;
  if (std::any_of(watched_.begin(), watched_.end(), is_same)) return;
  watched_.push_back({});
  watched_.back().taxel = taxel;
}

ReadingVerdict ImpossibleReadingDetector::verdict(const Observation& seen, std::size_t taxel) const noexcept {
  if (seen.conditioned.taxels[taxel] == TaxelStatus::invalid) return ReadingVerdict::possible;
  const bool is_saturated = seen.conditioned.taxels[taxel] == TaxelStatus::saturated;
  if (rows_tell_ && is_saturated && row_is_silent(seen, taxel)) {
    return ReadingVerdict::shorted;
  }
  const ReadingVerdict own = verdicts_[taxel];
  if (own == ReadingVerdict::unknown) return own;
  if (!columns_tell_ || own == ReadingVerdict::impossible) return own;
  const ReadingVerdict column = verdict_of_column(seen, taxel);
  return column == ReadingVerdict::impossible || own == ReadingVerdict::possible ? column : own;
}

/// Taxels at the end of the ADC do not count, but must be few: the currents of many take the row's voltage.
bool ImpossibleReadingDetector::row_is_silent(const Observation& seen, std::size_t taxel) const noexcept {
  const std::size_t row = taxel / array_.cols;
  double lacking = 0.0;
  std::size_t count = 0;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    const std::size_t other = array_.index(row, col);
    if (seen.conditioned.taxels[other] == TaxelStatus::saturated) continue;
    lacking += kSilentShare * seen.unloaded.ratio()[other] - seen.conditioned.ratio[other];
    ++count;
  }
  const bool are_enough = count >= kFewestSilent && 2 * count >= array_.cols;
  return are_enough && lacking > kSilentSigmas * seen.conditioned.sigma_ratio * std::sqrt(static_cast<double>(count));
}

void ImpossibleReadingDetector::find(const Observation& seen, ReadingVerdict verdict, Watched& watched,
                                     FaultList& faults) const noexcept {
  const double ratio = seen.conditioned.ratio[watched.taxel];
  const Nanos time = seen.conditioned.time;
  const double sigmas = ratio / seen.conditioned.sigma_ratio;  // as counts do, it repeats where the supply changes
  watched.repetitions += watched.frames > 0 && std::abs(sigmas - watched.last_sigmas) < kSame ? 1 : 0;
  watched.last_sigmas = sigmas;
  ++watched.frames;
  const bool may_be_short = possible_.share_of_most(watched.taxel, ratio) > kStillShorted;
  const double otherwise = verdict <= ReadingVerdict::unknown && may_be_short ? 0.0 : -kPerFrame;
  watched.shorted.add(verdict == ReadingVerdict::shorted ? kPerFrame : otherwise, seen.frame, time);
  watched.impossible.add(evidence_of_impossible(seen, verdict, watched.taxel), seen.frame, time);
  const bool is_impossible = watched.impossible.decides(kFrames);
  if (!is_impossible && !watched.shorted.decides(kFrames)) return;
  const bool repeats =
      array_.readout.adc_noise_counts > kNoiseThatShows && watched.repetitions > kMostRepetitions * watched.frames;
  const PageTest& test = is_impossible ? watched.impossible : watched.shorted;
  const bool is_stuck = repeats && array_.readout.circuit != Circuit::transimpedance;
  const LineFaultKind kind_below = is_stuck ? LineFaultKind::stuck_taxel : LineFaultKind::shorted_crossing;
  faults.add({.kind = is_impossible ? LineFaultKind::impossible_reading : kind_below,
              .place = watched.taxel,
              .frame = test.first_frame,
              .time = test.first_time});
  watched.released.restart();
}

double ImpossibleReadingDetector::evidence_of_impossible(const Observation& seen, ReadingVerdict verdict,
                                                         std::size_t taxel) const noexcept {
  if (verdict == ReadingVerdict::unknown) return 0.0;
  if (verdict != ReadingVerdict::impossible) return -kPerFrame;
  const bool is_taken = seen.conductance.taxels[taxel] == TaxelStatus::invalid;
  return is_taken ? kPerFrame : kPerFrameOfColumn;
}

void ImpossibleReadingDetector::heal(const Observation& seen, ReadingVerdict verdict, LineFaultKind kind,
                                     Watched& watched, FaultList& faults) const noexcept {
  const double ratio = seen.conditioned.ratio[watched.taxel];
  const bool reads_little = possible_.share_of_most(watched.taxel, ratio) < kStillShorted &&
                            seen.conditioned.taxels[watched.taxel] != TaxelStatus::saturated;
  const bool is_gone = verdict == ReadingVerdict::possible && (kind != LineFaultKind::shorted_crossing || reads_little);
  const double evidence = verdict == ReadingVerdict::unknown ? 0.0 : is_gone ? kPerFrame : -kEvidence;
  watched.released.add(evidence, seen.frame, seen.conditioned.time);
  if (!watched.released.decides(kHealFrames)) return;
  faults.remove(kind, watched.taxel);
  watched.shorted.restart();
  watched.impossible.restart();
}

}  // namespace dermis::touch::compensation
