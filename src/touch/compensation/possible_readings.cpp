// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/possible_readings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kAllowedShare = 0.02;  // by which resistances of the readout and the supply may be wrong
constexpr double kAllowedSigmas = 6.0;
constexpr double kShortOhm = 10.0;      // of taxels none has less
constexpr double kMostShortOhm = 30.0;  // a wide press where rows float, or a supply wrong by 3 %, looks like more
constexpr double kShortOfLoad = 0.015;  // likewise
constexpr double kShortShare = 0.005;   // as kAllowedShare; a mistake costs one taxel
constexpr double kStillShort = 4.0;     // times as many ohm, where the last reading was not believed
constexpr double kStillShare = 0.03;    // likewise, of the supply
constexpr double kLeastOfShort = 0.25;  // of the supply: where up to three short one column
constexpr double kLeastOfNode = 0.1;    // of the supply: where up to six lines are one
constexpr double kMostOfShare = 1.5;    // the current of a short over its line's share of the load
constexpr double kImplied = 3.0;        // times the limits, where other shorts already join two lines
constexpr double kMostly = 0.7;         // of a line's current
constexpr double kLittleLeft = 0.6;     // readings of a line together, over what a taxel of 0 ohm reads alone

/// Most that a film brings to a line from its neighbours beside a taxel of it [S].
double most_film_siemens(const ArrayDescription& array) {
  if (!array.readout.film) return 0.0;
  return 2.0 * static_cast<double>(array.rows + array.cols) / array.readout.film->loaded_ohm;
}

/// Most impossible readings of a line of so many taxels: with more, none of its readings counts.
std::size_t most_bad(std::size_t taxels) {
  return std::max<std::size_t>(2, taxels / 4);
}

}  // namespace

PossibleReadings::PossibleReadings(const ArrayDescription& array)
    : cols_(array.cols),
      rows_are_driven_(driven_axis(array) == Axis::row),
      one_loaded_(!rows_are_driven_ || array.readout.idle_columns == IdleColumns::floating),
      sums_are_bounded_(has_grounded_idle_lines(array.readout)),
      lines_may_be_joined_(array.readout.circuit != Circuit::transimpedance),
      most_ratio_(array.taxel_count(), std::numeric_limits<double>::infinity()) {
  if (array.readout.circuit == Circuit::none) return;
  drive_ohm_ = array.readout.drive_ohm;
  taken_.resize(array.taxel_count());
  last_taken_.resize(array.taxel_count());
  verdicts_.resize(array.taxel_count());
  known_.resize(array.taxel_count());
  joined_.resize(array.taxel_count());
  totals_.resize(array.driven_lines());
  sums_.resize(array.sensed_lines());
  line_.resize(array.sensed_lines());
  margins_.resize(array.sensed_lines());
  const double weakest_driver = *std::max_element(drive_ohm_.begin(), drive_ohm_.end());
  for (std::size_t line = 0; line < array.sensed_lines(); ++line) {
    const SensedLine sensed = sensed_line(array.readout, line);
    const double bare_ohm = std::clamp(kShortOfLoad * sensed.rho, kShortOhm, kMostShortOhm);
    const double short_ohm = bare_ohm / (1.0 + bare_ohm * most_film_siemens(array));
    heads_.push_back({1.0 / sensed.gain, -sensed.offset / sensed.gain, sensed.rho, sensed.emf, short_ohm,
                      sensed.rho / (sensed.rho + weakest_driver + short_ohm)});
    limits_.current.push_back(heads_.back().current);
    limits_.offset.push_back(heads_.back().offset);
    limits_.ohm.push_back(sensed.rho + short_ohm);
    limits_.emf.push_back(sensed.emf);
    for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
      const double series = drive_ohm_[driven] + sensed.rho;
      if (!(series > 0.0)) continue;
      most_ratio_[taxel_of(driven, line)] = sensed.gain * (1.0 - sensed.emf) / series + sensed.offset;
    }
  }
}

void PossibleReadings::check(std::span<const double> ratio, double sigma_ratio,
                             std::span<TaxelStatus> taxels) noexcept {
  if (drive_ohm_.empty()) return;
  std::swap(taken_, last_taken_);
  std::fill(taken_.begin(), taken_.end(), std::uint8_t{0});
  const bool is_wary = std::exchange(any_taken_, false);
  if (!is_wary && !any_may_exceed(ratio)) return;
  judge(ratio, sigma_ratio, taxels, verdicts_);
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    if (taxels[taxel] == TaxelStatus::invalid || verdicts_[taxel] == ReadingVerdict::possible) continue;
    taxels[taxel] = TaxelStatus::invalid;
    taken_[taxel] = 1;
    any_taken_ = true;
  }
}

bool PossibleReadings::any_may_exceed(std::span<const double> ratio) noexcept {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  double least_left = 1.0;
  bool any = false;
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    const double* const readings = readings_of(driven, ratio);
    add_up(readings);
    const Slack slack = find_slack(driven, readings);
    least_left = std::min(least_left, slack.left);
    any = any || slack.least < 0.0;
  }
  for (std::size_t sensed = 0; sensed < heads_.size() && sums_are_bounded_; ++sensed) {
    const Head& head = heads_[sensed];
    any = any || sums_[sensed] > head.most_sum ||
          sums_[sensed] * (1.0 + kShortShare + head.short_ohm / head.ohm) > least_left;
  }
  return any;
}

DERMIS_PROCESSOR_CLONES void PossibleReadings::add_up(const double* readings) noexcept {
  double* const sums = sums_.data();
  for (std::size_t sensed = 0; sensed < sums_.size(); ++sensed) sums[sensed] += readings[sensed];
}

/// Of taxels that are no shorts.
DERMIS_PROCESSOR_CLONES PossibleReadings::Slack PossibleReadings::find_slack(std::size_t driven,
                                                                             const double* readings) const noexcept {
  const std::size_t sensed_lines = heads_.size();
  const double* const current = limits_.current.data();
  const double* const offset = limits_.offset.data();
  const double* const ohm = limits_.ohm.data();
  const double* const emf = limits_.emf.data();
  double total = 0.0;
#pragma omp simd reduction(+ : total)
  for (std::size_t sensed = 0; sensed < sensed_lines; ++sensed) {
    total += current[sensed] * readings[sensed] + offset[sensed];
  }
  const double own_ohm = one_loaded_ ? drive_ohm_[driven] : 0.0;
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (std::size_t sensed = 0; sensed < sensed_lines; ++sensed) {
    const double own = current[sensed] * readings[sensed] + offset[sensed];
    const double taken = (ohm[sensed] + own_ohm) * own + emf[sensed];
    most = taken > most ? taken : most;
  }
  const double left = one_loaded_ ? 1.0 : 1.0 - drive_ohm_[driven] * total;
  return {left, left - most};
}

/// No reading of the line is near its limits.
bool PossibleReadings::is_clean(std::size_t driven, std::span<const double> ratio,
                                std::span<const ReadingVerdict> verdicts) noexcept {
  for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
    const std::size_t taxel = taxel_of(driven, sensed);
    if (verdicts[taxel] != ReadingVerdict::possible || was_taken(taxel)) return false;
  }
  return find_slack(driven, readings_of(driven, ratio)).least >= 0.0;
}

/// One after the other.
const double* PossibleReadings::readings_of(std::size_t driven, std::span<const double> ratio) noexcept {
  if (rows_are_driven_) return &ratio[driven * cols_];
  for (std::size_t sensed = 0; sensed < line_.size(); ++sensed) line_[sensed] = ratio[taxel_of(driven, sensed)];
  return line_.data();
}

void PossibleReadings::doubt_bad_lines(std::span<ReadingVerdict> verdicts) const noexcept {
  const auto is_bad = [&](std::size_t taxel) {
    return verdicts[taxel] >= ReadingVerdict::shorted && joined_[taxel] == 0;
  };
  const auto doubt = [&](std::size_t size, const auto& taxel_at) {
    std::size_t bad = 0;
    for (std::size_t k = 0; k < size; ++k) bad += is_bad(taxel_at(k)) ? 1 : 0;
    for (std::size_t k = 0; k < size && bad > most_bad(size); ++k) verdicts[taxel_at(k)] = ReadingVerdict::unknown;
  };
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    doubt(heads_.size(), [&](std::size_t sensed) { return taxel_of(driven, sensed); });
  }
  for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
    doubt(drive_ohm_.size(), [&](std::size_t driven) { return taxel_of(driven, sensed); });
  }
}

void PossibleReadings::set_shorted(std::span<const std::size_t> taxels) noexcept {
  std::fill(known_.begin(), known_.end(), std::uint8_t{0});
  for (const std::size_t taxel : taxels) known_[taxel] = 1;
}

void PossibleReadings::forget() noexcept {
  any_taken_ = false;
  std::fill(taken_.begin(), taken_.end(), std::uint8_t{0});
}

void PossibleReadings::judge(std::span<const double> ratio, double sigma_ratio, std::span<const TaxelStatus> taxels,
                             std::span<ReadingVerdict> verdicts) noexcept {
  std::transform(taxels.begin(), taxels.end(), verdicts.begin(), [](TaxelStatus status) {
    return status == TaxelStatus::invalid ? ReadingVerdict::unknown : ReadingVerdict::possible;
  });
  std::copy(known_.begin(), known_.end(), joined_.begin());
  if (lines_may_be_joined_) judge_joined(ratio, sigma_ratio, verdicts);
  std::size_t bad_lines = 0;
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    if (is_clean(driven, ratio, verdicts)) continue;
    bad_lines += judge_driven(driven, ratio, sigma_ratio, verdicts) > most_bad(heads_.size()) ? 1 : 0;
    if (2 * bad_lines <= drive_ohm_.size()) continue;
    std::fill(verdicts.begin(), verdicts.end(), ReadingVerdict::unknown);
    return;
  }
  for (std::size_t sensed = 0; sensed < heads_.size() && sums_are_bounded_; ++sensed) {
    judge_sensed(sensed, ratio, sigma_ratio, verdicts);
  }
  doubt_bad_lines(verdicts);
}

void PossibleReadings::judge_joined(std::span<const double> ratio, double sigma_ratio,
                                    std::span<ReadingVerdict> verdicts) noexcept {
  std::fill(totals_.begin(), totals_.end(), 0.0);
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
      const std::size_t taxel = taxel_of(driven, sensed);
      if (verdicts[taxel] == ReadingVerdict::unknown) continue;
      totals_[driven] += current(sensed, ratio[taxel]);
      sums_[sensed] += ratio[taxel];
    }
  }
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
      const std::size_t taxel = taxel_of(driven, sensed);
      if (verdicts[taxel] == ReadingVerdict::unknown || ratio[taxel] < kLeastOfNode) continue;
      if (are_joined(driven, sensed, ratio, sigma_ratio)) joined_[taxel] = 1;
    }
  }
  for (std::size_t taxel = 0; taxel < verdicts.size(); ++taxel) {
    if (joined_[taxel] != 0 && verdicts[taxel] != ReadingVerdict::unknown) verdicts[taxel] = ReadingVerdict::shorted;
  }
}

/// They are one node, and so are all that either is joined with: each such driven line with each such sensed one.
/// Little of their current goes or comes elsewhere.
bool PossibleReadings::are_joined(std::size_t driven, std::size_t sensed, std::span<const double> ratio,
                                  double sigma_ratio) const noexcept {
  const auto are_one = [&](std::size_t line, std::size_t other, double allowed) {
    return are_one_node(line, other, ratio, sigma_ratio, allowed);
  };
  if (!are_one(driven, sensed, 1.0)) return false;
  double sum = 0.0;
  for (std::size_t line = 0; line < drive_ohm_.size(); ++line) {
    if (are_one(line, sensed, kImplied)) sum += ratio[taxel_of(line, sensed)];
  }
  if (sums_are_bounded_ && sum < kMostly * sums_[sensed]) return false;
  double total = 0.0;
  for (std::size_t other = 0; other < heads_.size(); ++other) {
    if (!are_one(driven, other, kImplied)) continue;
    total += current(other, ratio[taxel_of(driven, other)]);
    if (!are_one(driven, other, 1.0)) continue;
    for (std::size_t line = 0; line < drive_ohm_.size(); ++line) {
      if (are_one(line, sensed, 1.0) && !are_one(line, other, kImplied)) return false;
    }
  }
  return one_loaded_ || total >= kMostly * totals_[driven];
}

/// Both stand at the same voltage with all driven, or in their own scan.
bool PossibleReadings::are_one_node(std::size_t driven, std::size_t sensed, std::span<const double> ratio,
                                    double sigma_ratio, double allowed) const noexcept {
  const std::size_t taxel = taxel_of(driven, sensed);
  const double own = ratio[taxel];
  if (!(own >= kLeastOfNode)) return false;
  const Head& head = heads_[sensed];
  const double left = 1.0 - drive_ohm_[driven] * (one_loaded_ ? current(sensed, own) : totals_[driven]);
  const double stands = sums_are_bounded_ ? sums_[sensed] : own;
  const double noise = 0.5 * kAllowedSigmas * sigma_ratio * std::sqrt(static_cast<double>(drive_ohm_.size()));
  const double drop = head.short_ohm / head.ohm * std::min(stands, kMostOfShare * own);
  return std::abs(left - stands) <= allowed * drop - kShortShare * stands - noise;
}

/// Returns how many readings of the line are bad; it ends when they are many.
std::size_t PossibleReadings::judge_driven(std::size_t driven, std::span<const double> ratio, double sigma_ratio,
                                           std::span<ReadingVerdict> verdicts) noexcept {
  double total = 0.0;
  for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
    const std::size_t taxel = taxel_of(driven, sensed);
    const double own = current(sensed, ratio[taxel]);
    margins_[sensed] = margins(driven, sensed, own, sigma_ratio);
    if (verdicts[taxel] != ReadingVerdict::unknown) total += own;
  }
  std::size_t bad = 0;
  for (; bad <= most_bad(heads_.size()); ++bad) {
    const double drop = one_loaded_ ? 0.0 : drive_ohm_[driven] * total;
    std::size_t worst = heads_.size();
    double least = 0.0;
    bool is_impossible = false;
    for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
      if (verdicts[taxel_of(driven, sensed)] != ReadingVerdict::possible) continue;
      const Margins& margin = margins_[sensed];
      const double of_circuit = margin.of_circuit - (1.0 - kAllowedShare) * drop;
      const double left = std::min(margin.of_short - margin.share_of_short * drop, of_circuit);
      if (!(left < least)) continue;
      least = left;
      is_impossible = of_circuit < 0.0;
      worst = sensed;
    }
    if (worst == heads_.size()) return bad;
    const std::size_t taxel = taxel_of(driven, worst);
    verdicts[taxel] = is_impossible ? ReadingVerdict::impossible : ReadingVerdict::shorted;
    if (is_impossible) total -= current(worst, ratio[taxel]);
  }
  return bad;
}

void PossibleReadings::judge_sensed(std::size_t sensed, std::span<const double> ratio, double sigma_ratio,
                                    std::span<ReadingVerdict> verdicts) const noexcept {
  const auto is_there = [&](std::size_t taxel) {
    return verdicts[taxel] == ReadingVerdict::possible || verdicts[taxel] == ReadingVerdict::shorted;
  };
  const double noise = kAllowedSigmas * sigma_ratio * std::sqrt(static_cast<double>(drive_ohm_.size()));
  double sum = 0.0;
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    const std::size_t taxel = taxel_of(driven, sensed);
    if (is_there(taxel)) sum += ratio[taxel];
  }
  for (std::size_t bad = 0; sum > 1.0 + kAllowedShare + noise && bad <= most_bad(drive_ohm_.size()); ++bad) {
    std::size_t worst = ratio.size();
    for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
      const std::size_t taxel = taxel_of(driven, sensed);
      if (is_there(taxel) && (worst == ratio.size() || ratio[taxel] > ratio[worst])) worst = taxel;
    }
    verdicts[worst] = ReadingVerdict::impossible;
    sum -= ratio[worst];
  }
  const Head& head = heads_[sensed];
  const double left = 1.0 - sum + kShortShare * sum + 0.5 * noise;
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    const std::size_t taxel = taxel_of(driven, sensed);
    if (verdicts[taxel] != ReadingVerdict::possible || ratio[taxel] < kLeastOfShort) continue;
    const double short_ohm = head.short_ohm * (was_taken(taxel) ? kStillShort : 1.0);
    if (left * head.ohm < (drive_ohm_[driven] + short_ohm) * ratio[taxel]) verdicts[taxel] = ReadingVerdict::shorted;
  }
}

/// `own` is the current of the taxel. Where all columns are loaded, those of its line make a further drop.
PossibleReadings::Margins PossibleReadings::margins(std::size_t driven, std::size_t sensed, double own,
                                                    double sigma_ratio) const noexcept {
  const Head& head = heads_[sensed];
  const double taken = head.ohm * own + head.emf + (one_loaded_ ? drive_ohm_[driven] * own : 0.0);
  const double doubt = kAllowedSigmas * sigma_ratio * std::max(head.ohm * head.current, 0.0);
  const bool is_wary = was_taken(taxel_of(driven, sensed));
  const double short_ohm = head.short_ohm * (is_wary ? kStillShort : 1.0);
  const double share_of_short = 1.0 - kShortShare + (is_wary ? kStillShare : 0.0);
  return {1.0 - share_of_short * taken + doubt - short_ohm * own, 1.0 - (1.0 - kAllowedShare) * taken + doubt,
          share_of_short};
}

bool PossibleReadings::take_largest(std::span<const double> ratio, std::span<TaxelStatus> taxels) noexcept {
  bool any = false;
  double most = 0.0;
  std::size_t largest_of_all = 0;
  for (std::size_t sensed = 0; sensed < sums_.size(); ++sensed) {
    double share = 0.0;
    double most_of_line = 0.0;
    std::size_t largest = 0;
    for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
      const std::size_t taxel = taxel_of(driven, sensed);
      if (taxels[taxel] == TaxelStatus::invalid) continue;
      const double own = share_of_most(taxel, ratio[taxel]);
      share += own;
      if (!(own > most_of_line)) continue;
      most_of_line = own;
      largest = taxel;
    }
    if (most_of_line > most) {
      most = most_of_line;
      largest_of_all = largest;
    }
    if (share < kLittleLeft) continue;
    taxels[largest] = TaxelStatus::invalid;
    any = true;
  }
  if (!any && most > 0.0) taxels[largest_of_all] = TaxelStatus::invalid;
  return any || most > 0.0;
}

bool PossibleReadings::take_full_lines(std::span<const double> ratio, std::span<TaxelStatus> taxels) noexcept {
  bool any = false;
  for (std::size_t sensed = 0; sensed < sums_.size(); ++sensed) {
    double share = 0.0;
    for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
      const std::size_t taxel = taxel_of(driven, sensed);
      share += share_of_most(taxel, ratio[taxel]);
    }
    for (std::size_t driven = 0; driven < drive_ohm_.size() && share >= kLittleLeft; ++driven) {
      TaxelStatus& status = taxels[taxel_of(driven, sensed)];
      any = any || status != TaxelStatus::invalid;
      status = TaxelStatus::invalid;
    }
  }
  return any;
}

}  // namespace dermis::touch::compensation
