// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/dead_taxel_detector.hpp"

#include <cmath>
#include <limits>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr float kCrosstalkShare = 0.3F;  // of the crosstalk from other taxels may be solved wrongly
constexpr int kPassedOver = 2;           // frames in which taxels on both sides are pressed
constexpr double kAboveSmallest = 4.0;  // times the smallest reading: a press that no threshold hides on a weaker taxel

}  // namespace

DeadTaxelDetector::DeadTaxelDetector(const ArrayDescription& array)
    : array_(array),
      floor_(floor_evidence(array.readout.adc_noise_counts)),
      evidence_(array.taxel_count()),
      dead_(array.taxel_count()),
      since_(array.taxel_count()),
      passed_over_(array.taxel_count()),
      alive_(array.taxel_count()) {}

void DeadTaxelDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  if (!seen.solved) return;
  const TaxelBlock block = TaxelBlock::of_frame(seen.frame, dead_.size());
  weigh(seen, block);
  if (seen.witnesses.are_doubtful()) forget(seen.frame, block);
  const float most = add_up(seen.frame, block);
  if (most < static_cast<float>(kEvidence) && !faults.contains(LineFaultKind::dead_taxel)) return;
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) judge_taxel(seen, taxel, faults);
}

DERMIS_PROCESSOR_CLONES void DeadTaxelDetector::weigh(const Observation& seen, const TaxelBlock& block) noexcept {
  const auto [from, to] = block;
  const FloorEvidence floor = floor_;
  const double* const siemens = seen.conductance.siemens.data();
  const double* const sigma = seen.conductance.sigma_siemens.data();
  const double* const unloaded = seen.unloaded.siemens().data();
  const float* const expected = seen.unloaded.least_reading().data();
  const double* const ratio = seen.conditioned.ratio.data();
  const double per_sigma_ratio = 1.0 / seen.conditioned.sigma_ratio;
  float* const evidence = evidence_.data();
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const auto reading = static_cast<float>(ratio[taxel] * per_sigma_ratio);
    const float known = 1.0F / std::sqrt(1.0F + kCrosstalkShare * kCrosstalkShare * reading * reading);
    const auto per_sigma = known / static_cast<float>(sigma[taxel]);
    const float conductance = static_cast<float>(siemens[taxel]) * per_sigma;
    const float least = static_cast<float>(kUnloadedShare * unloaded[taxel]) * per_sigma;
    const float mean = expected[taxel] > 0.0F ? least : 0.0F;
    evidence[taxel] = silence_evidence(conductance, mean, std::numeric_limits<float>::min(), floor, kMostForTaxel);
  }
}

/// The largest of the block's sums.
DERMIS_PROCESSOR_CLONES float DeadTaxelDetector::add_up(std::size_t frame, const TaxelBlock& block) noexcept {
  const auto [from, to] = block;
  const auto next_frame = static_cast<std::int32_t>(frame) + 1;
  const float* const evidence = evidence_.data();
  float* const dead = dead_.data();
  std::int32_t* const since = since_.data();
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    const float sum = dead[taxel] + evidence[taxel];
    const std::int32_t began = since[taxel];
    since[taxel] = sum > 0.0F ? began : next_frame;
    dead[taxel] = sum > 0.0F ? sum : 0.0F;
  }
  float most = 0.0F;
  for (std::size_t taxel = from; taxel < to; ++taxel) most = dead[taxel] > most ? dead[taxel] : most;
  return most;
}

void DeadTaxelDetector::forget(std::size_t frame, const TaxelBlock& block) noexcept {
  for (std::size_t taxel = block.from; taxel < block.to; ++taxel) {
    dead_[taxel] = 0.0F;
    since_[taxel] = static_cast<std::int32_t>(frame) + 1;
    passed_over_[taxel] = 0;
  }
}

/// Taxels are pressed on both sides on its row, or on its column.
bool DeadTaxelDetector::is_between_presses(const Observation& seen, std::size_t taxel) const noexcept {
  const double least = kAboveSmallest * seen.unloaded.smallest_reading();
  const auto is_pressed = [&](std::size_t other) {
    return seen.is_pressed(other) && seen.conditioned.ratio[other] > least;
  };
  const std::size_t row = taxel / array_.cols;
  const std::size_t col = taxel % array_.cols;
  return (col > 0 && col + 1 < array_.cols && is_pressed(taxel - 1) && is_pressed(taxel + 1)) ||
         (row > 0 && row + 1 < array_.rows && is_pressed(taxel - array_.cols) && is_pressed(taxel + array_.cols));
}

void DeadTaxelDetector::judge_taxel(const Observation& seen, std::size_t taxel, FaultList& faults) noexcept {
  const std::uint8_t causes = faults.causes(taxel);
  if ((causes & ~kDeadCause) != 0) {
    dead_[taxel] = 0.0F;
    since_[taxel] = static_cast<std::int32_t>(seen.frame) + 1;
  } else if ((causes & kDeadCause) != 0) {
    alive_[taxel].add(static_cast<double>(-evidence_[taxel]), seen.frame, seen.conditioned.time);
    if (!alive_[taxel].decides(kHealFrames)) return;
    faults.remove(LineFaultKind::dead_taxel, taxel);
    dead_[taxel] = 0.0F;
  } else if (evidence_[taxel] < -kMostForTaxel) {
    passed_over_[taxel] = 0;
  } else if (dead_[taxel] >= static_cast<float>(kEvidence)) {
    passed_over_[taxel] += is_between_presses(seen, taxel) ? 1 : 0;
    if (passed_over_[taxel] < kPassedOver) return;
    passed_over_[taxel] = 0;
    faults.add({.kind = LineFaultKind::dead_taxel,
                .place = taxel,
                .frame = static_cast<std::size_t>(since_[taxel]),
                .time = seen.conditioned.time});
    alive_[taxel].restart();
  }
}

}  // namespace dermis::touch::compensation
