// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/possible_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "compensation/readout_parts.hpp"
#include "compensation/sensed_line.hpp"
#include "dermis/core/axis.hpp"
#include "dermis/core/processor_clones.hpp"

namespace dermis::compensation {
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
constexpr double kLittleLeft = 0.6;     // readings of a line together, over what a taxel of 0 ohm reads alone
constexpr std::size_t kAtOnce = 8;      // sums that do not wait for each other

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
      most_ratio_(array.taxel_count(), std::numeric_limits<double>::infinity()) {
  if (array.readout.circuit == Circuit::none) return;
  drive_ohm_ = array.readout.drive_ohm;
  taken_.resize(array.taxel_count());
  last_taken_.resize(array.taxel_count());
  verdicts_.resize(array.taxel_count());
  sums_.resize(array.sensed_lines());
  const double weakest_driver = *std::max_element(drive_ohm_.begin(), drive_ohm_.end());
  for (std::size_t line = 0; line < array.sensed_lines(); ++line) {
    const SensedLine sensed = sensed_line(array.readout, line);
    const double short_ohm = std::clamp(kShortOfLoad * sensed.rho, kShortOhm, kMostShortOhm);
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
  bool any = false;
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) any = driven_may_exceed(driven, ratio) || any;
  for (std::size_t sensed = 0; sensed < heads_.size() && sums_are_bounded_; ++sensed) {
    any = any || sums_[sensed] > heads_[sensed].most_sum;
  }
  return any;
}

/// Nothing on the line is above its limits, as the sum and the largest of its readings show. Adds these to the sums.
DERMIS_PROCESSOR_CLONES bool PossibleReadings::driven_may_exceed(std::size_t driven,
                                                                 std::span<const double> ratio) noexcept {
  const std::size_t sensed_lines = heads_.size();
  const std::size_t step = rows_are_driven_ ? 1 : cols_;
  const double* const readings = ratio.data() + taxel_of(driven, 0);
  const double* const current = limits_.current.data();
  const double* const offset = limits_.offset.data();
  const double* const ohm = limits_.ohm.data();
  const double* const emf = limits_.emf.data();
  double* const sums = sums_.data();
  for (std::size_t sensed = 0; sensed < sensed_lines; ++sensed) sums[sensed] += readings[sensed * step];
  double parts[kAtOnce] = {};
  std::size_t first = 0;
  for (; first + kAtOnce <= sensed_lines; first += kAtOnce) {
    for (std::size_t k = 0; k < kAtOnce; ++k) {
      parts[k] += current[first + k] * readings[(first + k) * step] + offset[first + k];
    }
  }
  for (; first < sensed_lines; ++first) parts[0] += current[first] * readings[first * step] + offset[first];
  const double total = std::accumulate(parts, parts + kAtOnce, 0.0);
  const double own_ohm = one_loaded_ ? drive_ohm_[driven] : 0.0;
  const double left = one_loaded_ ? 1.0 : 1.0 - drive_ohm_[driven] * total;
  std::uint64_t exceeds = 0;
  for (std::size_t sensed = 0; sensed < sensed_lines; ++sensed) {
    const double own = current[sensed] * readings[sensed * step] + offset[sensed];
    exceeds |= (ohm[sensed] + own_ohm) * own + emf[sensed] > left ? 1 : 0;
  }
  return exceeds != 0 || left < 0.0;
}

void PossibleReadings::doubt_bad_lines(std::span<ReadingVerdict> verdicts) const noexcept {
  const auto doubt = [&](std::size_t size, const auto& taxel_at) {
    std::size_t bad = 0;
    for (std::size_t k = 0; k < size; ++k) bad += verdicts[taxel_at(k)] >= ReadingVerdict::shorted ? 1 : 0;
    for (std::size_t k = 0; k < size && bad > most_bad(size); ++k) verdicts[taxel_at(k)] = ReadingVerdict::unknown;
  };
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    doubt(heads_.size(), [&](std::size_t sensed) { return taxel_of(driven, sensed); });
  }
  for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
    doubt(drive_ohm_.size(), [&](std::size_t driven) { return taxel_of(driven, sensed); });
  }
}

void PossibleReadings::forget() noexcept {
  any_taken_ = false;
  std::fill(taken_.begin(), taken_.end(), std::uint8_t{0});
}

void PossibleReadings::judge(std::span<const double> ratio, double sigma_ratio, std::span<const TaxelStatus> taxels,
                             std::span<ReadingVerdict> verdicts) const noexcept {
  std::transform(taxels.begin(), taxels.end(), verdicts.begin(), [](TaxelStatus status) {
    return status == TaxelStatus::invalid ? ReadingVerdict::unknown : ReadingVerdict::possible;
  });
  for (std::size_t driven = 0; driven < drive_ohm_.size(); ++driven) {
    judge_driven(driven, ratio, sigma_ratio, verdicts);
  }
  for (std::size_t sensed = 0; sensed < heads_.size() && sums_are_bounded_; ++sensed) {
    judge_sensed(sensed, ratio, sigma_ratio, verdicts);
  }
  doubt_bad_lines(verdicts);
}

void PossibleReadings::judge_driven(std::size_t driven, std::span<const double> ratio, double sigma_ratio,
                                    std::span<ReadingVerdict> verdicts) const noexcept {
  double total = 0.0;
  for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
    const std::size_t taxel = taxel_of(driven, sensed);
    if (verdicts[taxel] != ReadingVerdict::unknown) total += current(sensed, ratio[taxel]);
  }
  for (std::size_t bad = 0; bad <= most_bad(heads_.size()); ++bad) {
    std::size_t worst = heads_.size();
    Margins least{0.0, 0.0};
    for (std::size_t sensed = 0; sensed < heads_.size(); ++sensed) {
      const std::size_t taxel = taxel_of(driven, sensed);
      if (verdicts[taxel] != ReadingVerdict::possible) continue;
      const Margins left = margins(driven, sensed, current(sensed, ratio[taxel]), total, sigma_ratio);
      if (!(left.least() < least.least())) continue;
      least = left;
      worst = sensed;
    }
    if (worst == heads_.size()) return;
    const std::size_t taxel = taxel_of(driven, worst);
    const bool is_impossible = least.of_circuit < 0.0;
    verdicts[taxel] = is_impossible ? ReadingVerdict::impossible : ReadingVerdict::shorted;
    if (is_impossible) total -= current(worst, ratio[taxel]);
  }
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

/// `own` is the current of the taxel, `total` that of all readings of the line.
PossibleReadings::Margins PossibleReadings::margins(std::size_t driven, std::size_t sensed, double own, double total,
                                                    double sigma_ratio) const noexcept {
  const Head& head = heads_[sensed];
  const double taken = head.ohm * own + head.emf + drive_ohm_[driven] * (one_loaded_ ? own : total);
  const double slack = 1.0 - taken;
  const double doubt = kAllowedSigmas * sigma_ratio * std::max(head.ohm * head.current, 0.0);
  const bool is_wary = was_taken(taxel_of(driven, sensed));
  const double short_ohm = head.short_ohm * (is_wary ? kStillShort : 1.0);
  const double nearer = is_wary ? kStillShare * taken : 0.0;
  return {slack + kShortShare * taken + doubt - short_ohm * own - nearer, slack + kAllowedShare * taken + doubt};
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

}  // namespace dermis::compensation
