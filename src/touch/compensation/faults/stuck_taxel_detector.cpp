// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/stuck_taxel_detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/faults/any_reading.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kSameCount = 1e-3;
constexpr std::int64_t kLeastOthers = 4;  // interior readings that show how often a reading repeats
constexpr double kLonger = 3.0;           // than any of those repeats
constexpr double kFades = 0.999;          // a visit
constexpr double kMaybeRail = 0.95;       // of the largest rise
constexpr int kHealChanges = 5;

/// Probability that a reading repeats, at least: `noise_counts` with the rounding of the ADC.
double repetition_by_noise(double noise_counts) {
  const double before_rounding = std::sqrt(std::max(noise_counts * noise_counts - 1.0 / 12, 0.0));
  return before_rounding > 0.0 ? std::erf(0.5 / (before_rounding * std::numbers::sqrt2)) : 1.0;
}

}  // namespace

StuckTaxelDetector::StuckTaxelDetector(const ArrayDescription& array)
    : readout_(array.readout),
      repeats_by_noise_(repetition_by_noise(array.readout.adc_noise_counts)),
      evidence_(array.taxel_count()),
      repetitions_(array.taxel_count()),
      last_counts_(array.taxel_count(), -1.0),
      changes_(array.taxel_count()) {}

void StuckTaxelDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  const TaxelBlock block = TaxelBlock::of_frame(seen.frame, evidence_.size());
  const CountScale scale = count_scale(seen.conditioned);
  follow_largest_rise(seen, scale, block);
  heal(seen, scale, block, faults);
  if (count_repetitions(seen, scale, block)) find(seen, block, faults);
}

StuckTaxelDetector::CountScale StuckTaxelDetector::count_scale(const ConditionedFrame& conditioned) const noexcept {
  const double supply = readout_.adc_noise_counts * conditioned.noise_growth / conditioned.sigma_ratio;
  return readout_.pressure_raises_reading ? CountScale{0.0, supply} : CountScale{supply, -supply};
}

void StuckTaxelDetector::follow_largest_rise(const Observation& seen, const CountScale& scale,
                                             const TaxelBlock& block) noexcept {
  const double per_ratio = std::abs(scale.per_ratio);
  const std::span<const double> readings = std::span(seen.conditioned.ratio).subspan(block.from, block.to - block.from);
  if (!any_is_above(readings, largest_rise_ / per_ratio)) return;
  largest_rise_ = std::max(largest_rise_, per_ratio * *std::max_element(readings.begin(), readings.end()));
}

void StuckTaxelDetector::heal(const Observation& seen, const CountScale& scale, const TaxelBlock& block,
                              FaultList& faults) noexcept {
  for (std::size_t k = faults.all().size(); k-- > 0;) {  // backwards: remove() moves those behind
    const LineFault& fault = faults.all()[k];
    const std::size_t taxel = fault.place;
    if (fault.kind != LineFaultKind::stuck_taxel || taxel < block.from || taxel >= block.to) continue;
    const double change = scale.zero + scale.per_ratio * seen.conditioned.ratio[taxel] - last_counts_[taxel];
    if (std::abs(change) < kSameCount || ++changes_[taxel] < kHealChanges) continue;
    faults.remove(LineFaultKind::stuck_taxel, taxel);
    evidence_[taxel] = 0.0;
    changes_[taxel] = 0;  // GroundedLineDetector may find it next
  }
}

/// Whether the evidence of any taxel of the block decides.
DERMIS_PROCESSOR_CLONES bool StuckTaxelDetector::count_repetitions(const Observation& seen, const CountScale& scale,
                                                                   const TaxelBlock& block) noexcept {
  const double zero = scale.zero;
  const double per_ratio = scale.per_ratio;
  const double most = readout_.full_scale_counts() - 0.5;
  const double most_pressed = kMaybeRail * largest_rise_ / std::abs(per_ratio);
  const double least_pressed = kPressedSigmas * seen.conditioned.sigma_ratio;
  const double chance = chance_;
  const double* const ratios = seen.conditioned.ratio.data();
  const double* const unloaded = seen.unloaded.ratio().data();
  double* const last_counts = last_counts_.data();
  double* const evidence = evidence_.data();
  std::int64_t* const repetitions = repetitions_.data();
  std::int64_t idle = 0;  // interior readings that nothing presses
  std::int64_t idle_repeated = 0;
  std::int64_t idle_repetitions = 0;
  std::int64_t any_decides = 0;
#pragma omp simd reduction(+ : idle, idle_repeated) reduction(max : idle_repetitions) reduction(| : any_decides)
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    const double ratio = ratios[taxel];
    const double count = zero + per_ratio * ratio;
    const std::int64_t is_interior = (count > 0.5 ? 1 : 0) & (count < most ? 1 : 0);
    const std::int64_t is_repeated = std::abs(count - last_counts[taxel]) < kSameCount ? is_interior : 0;
    const std::int64_t is_pressed = ratio > kTouchedShare * unloaded[taxel] + least_pressed ? 1 : 0;
    const std::int64_t is_below_rail = ratio < most_pressed ? 1 : 0;
    const std::int64_t is_idle = 1 - is_pressed;
    last_counts[taxel] = count;
    idle += is_interior & is_idle;
    idle_repeated += is_repeated & is_idle;
    const double added = evidence[taxel] + chance;
    evidence[taxel] = (is_repeated & is_pressed & is_below_rail) != 0 ? added : 0.0;
    any_decides |= evidence[taxel] >= kEvidence ? 1 : 0;
    const std::int64_t in_a_row = is_repeated != 0 ? repetitions[taxel] + 1 : 0;
    repetitions[taxel] = in_a_row;
    idle_repetitions = std::max(idle_repetitions, is_idle != 0 ? in_a_row : 0);
  }
  idle_repetitions_ = std::max(kFades * idle_repetitions_, static_cast<double>(idle_repetitions));
  chance_ = idle < kLeastOthers ? 0.0 : chance_of_share(static_cast<double>(idle_repeated) / static_cast<double>(idle));
  return any_decides != 0;
}

double StuckTaxelDetector::chance_of_share(double share) const noexcept {
  return std::min(-std::log(std::max(repeats_by_noise_, share)), static_cast<double>(kMostForTaxel));
}

void StuckTaxelDetector::find(const Observation& seen, const TaxelBlock& block, FaultList& faults) noexcept {
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    if (evidence_[taxel] < kEvidence || (faults.causes(taxel) & kStuckCause) != 0) continue;
    if (static_cast<double>(repetitions_[taxel]) < kLonger * idle_repetitions_) continue;
    const std::size_t frames = static_cast<std::size_t>(repetitions_[taxel]) * TaxelBlock::count(evidence_.size());
    faults.add({.kind = LineFaultKind::stuck_taxel,
                .place = taxel,
                .frame = seen.frame - std::min(seen.frame, frames),
                .time = seen.conditioned.time});
  }
}

}  // namespace dermis::touch::compensation
