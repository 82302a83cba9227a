// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/stuck_taxel_detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::compensation {
namespace {

constexpr double kSameCount = 1e-3;
constexpr double kLeastOthers = 4.0;  // interior readings that show how often a reading repeats
constexpr double kLonger = 3.0;       // than any of those repeats
constexpr double kFades = 0.999;      // a visit
constexpr double kMaybeRail = 0.95;   // of the largest rise
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
  const CountScale scale = count_scale(seen.conditioned.sigma_ratio);
  follow_largest_rise(seen, scale, block);
  heal(seen, scale, block, faults);
  if (count_repetitions(seen, scale, block) >= kEvidence) find(seen, block, faults);
}

StuckTaxelDetector::CountScale StuckTaxelDetector::count_scale(double sigma_ratio) const noexcept {
  const double supply = readout_.adc_noise_counts / sigma_ratio;
  return readout_.pressure_raises_reading ? CountScale{0.0, supply} : CountScale{supply, -supply};
}

void StuckTaxelDetector::follow_largest_rise(const Observation& seen, const CountScale& scale,
                                             const TaxelBlock& block) noexcept {
  double largest = 0.0;
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    largest = std::max(largest, seen.conditioned.ratio[taxel]);
  }
  largest_rise_ = std::max(largest_rise_, std::abs(scale.per_ratio) * largest);
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

/// The largest evidence of the block.
double StuckTaxelDetector::count_repetitions(const Observation& seen, const CountScale& scale,
                                             const TaxelBlock& block) noexcept {
  const auto [from, to] = block;
  const double most = readout_.full_scale_counts() - 0.5;
  const double most_pressed = kMaybeRail * largest_rise_ / std::abs(scale.per_ratio);
  const double least_pressed = kPressedSigmas * seen.conditioned.sigma_ratio;
  const double chance = chance_;
  const double* const ratios = seen.conditioned.ratio.data();
  const double* const unloaded = seen.unloaded.ratio().data();
  double* const last_counts = last_counts_.data();
  double* const evidence = evidence_.data();
  double* const repetitions = repetitions_.data();
  double idle = 0.0;  // interior readings that nothing presses
  double idle_repeated = 0.0;
  double idle_repetitions = 0.0;
  double most_evidence = 0.0;
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const double ratio = ratios[taxel];
    const double count = scale.zero + scale.per_ratio * ratio;
    const double interior = (count > 0.5 ? 1.0 : 0.0) * (count < most ? 1.0 : 0.0);
    const double repeated = std::abs(count - last_counts[taxel]) < kSameCount ? interior : 0.0;
    const double pressed = ratio > kTouchedShare * unloaded[taxel] + least_pressed ? 1.0 : 0.0;
    last_counts[taxel] = count;
    idle += interior * (1.0 - pressed);
    idle_repeated += repeated * (1.0 - pressed);
    const double below_rail = ratio < most_pressed ? 1.0 : 0.0;
    evidence[taxel] = repeated * pressed * below_rail * (evidence[taxel] + chance);
    repetitions[taxel] = repeated * (repetitions[taxel] + 1.0);
    const double of_idle = (1.0 - pressed) * repetitions[taxel];
    idle_repetitions = of_idle > idle_repetitions ? of_idle : idle_repetitions;
    most_evidence = evidence[taxel] > most_evidence ? evidence[taxel] : most_evidence;
  }
  idle_repetitions_ = std::max(kFades * idle_repetitions_, idle_repetitions);
  chance_ = idle < kLeastOthers ? 0.0 : -std::log(std::max(repeats_by_noise_, idle_repeated / idle));
  chance_ = std::min(chance_, static_cast<double>(kMostForTaxel));
  return most_evidence;
}

void StuckTaxelDetector::find(const Observation& seen, const TaxelBlock& block, FaultList& faults) noexcept {
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    if (evidence_[taxel] < kEvidence || (faults.causes(taxel) & kStuckCause) != 0) continue;
    if (repetitions_[taxel] < kLonger * idle_repetitions_) continue;
    const std::size_t frames = static_cast<std::size_t>(repetitions_[taxel]) * TaxelBlock::count(evidence_.size());
    faults.add({.kind = LineFaultKind::stuck_taxel,
                .place = taxel,
                .frame = seen.frame - std::min(seen.frame, frames),
                .time = seen.conditioned.time});
  }
}

}  // namespace dermis::compensation
