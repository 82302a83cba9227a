// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/silent_line_detector.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr float kMostOfTaxel = 8.0F;  // evidence of one taxel in one frame
constexpr double kFoundWithinFrames = 30.0;
constexpr double kMeanOfNoise = 0.4;  // of normal noise that is cut off at 0 [standard deviations],
constexpr double kDeviationOfNoise = 0.6;
constexpr double kNoiseSigmas = 3.0;
constexpr double kSuddenEvidence = 1.0;
constexpr Nanos kSudden = std::chrono::seconds(1);
constexpr Nanos kNever = Nanos::min();
constexpr std::size_t kNoiseIsKnown = 64;  // frames after it has begun, at most

constexpr PerAxis<LineFaultKind> kSilent{.row = LineFaultKind::silent_row, .column = LineFaultKind::silent_column};
constexpr PerAxis<LineFaultKind> kSupplied{.row = LineFaultKind::supplied_row,
                                           .column = LineFaultKind::supplied_column};

}  // namespace

SilentLineDetector::SilentLineDetector(const ArrayDescription& array, const UnloadedTaxels& unloaded,
                                       UnloadedWitnesses& witnesses)
    : array_(array),
      unloaded_(unloaded),
      witnesses_(witnesses),
      floor_(floor_evidence(array.readout.adc_noise_counts)),
      evidence_(array.taxel_count()),
      line_evidence_{std::vector<float>(array.rows), std::vector<float>(array.cols)},
      read_{std::vector<Nanos>(array.rows, kNever), std::vector<Nanos>(array.cols, kNever)},
      tests_{std::vector<LineTests>(array.rows), std::vector<LineTests>(array.cols)} {}

void SilentLineDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  last_sigma_ratio_ = seen.conditioned.sigma_ratio;
  if (last_noise_growth_ == 1.0) noise_frame_ = seen.frame;
  last_noise_growth_ = seen.conditioned.noise_growth;
  weigh_taxels(seen);
  sum_over_lines(faults);
  witnesses_.follow(line_evidence_);
  for (const Axis axis : kAxes) judge_lines(seen, axis, faults);
}

bool SilentLineDetector::sees(Axis axis, std::size_t line) const noexcept {
  const double rounded_to_none = kRoundedToNone / (array_.readout.adc_noise_counts * last_noise_growth_);
  const double least_sigmas = std::max(rounded_to_none, hum_sigmas(last_noise_growth_));
  double per_frame = 0.0;
  for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
    const double mean = unloaded_.least_ratio(taxel_on_line(array_, axis, line, k)) / last_sigma_ratio_;
    if (mean < least_sigmas) continue;
    per_frame += std::min(floor_.information * mean * mean, static_cast<double>(kMostOfTaxel));
  }
  return last_sigma_ratio_ > 0.0 && per_frame >= kEvidence / kFoundWithinFrames;
}

DERMIS_PROCESSOR_CLONES void SilentLineDetector::weigh_taxels(const Observation& seen) noexcept {
  const std::size_t taxels = evidence_.size();
  const double per_sigma = 1.0 / seen.conditioned.sigma_ratio;
  const FloorEvidence floor = floor_;
  const double* const ratios = seen.conditioned.ratio.data();
  const float* const expected = unloaded_.least_reading().data();
  float* const evidence = evidence_.data();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto reading = static_cast<float>(ratios[taxel] * per_sigma);
    evidence[taxel] = silence_evidence(reading, expected[taxel], floor.sigmas, floor, kMostOfTaxel);
  }
}

DERMIS_PROCESSOR_CLONES void SilentLineDetector::sum_over_lines(const FaultList& faults) noexcept {
  const std::size_t cols = array_.cols;
  float* const columns = line_evidence_.column.data();
  std::fill_n(columns, cols, 0.0F);
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const float* const evidence = &evidence_[row * cols];
    const float* const of_column = &faults.witnesses(Axis::column)[row * cols];
    const float* const of_row = &faults.witnesses(Axis::row)[row * cols];
    float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
    for (std::size_t col = 0; col < cols; ++col) {
      columns[col] += of_column[col] * evidence[col];
      sum += of_row[col] * evidence[col];
    }
    line_evidence_.row[row] = sum;
  }
}

void SilentLineDetector::judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept {
  const Nanos time = seen.conditioned.time;
  const bool none_is_known = faults.all().empty();
  for (std::size_t line = 0; line < line_count(array_, axis); ++line) {
    const auto evidence = static_cast<double>(line_evidence_[axis][line]);
    LineTests& tests = tests_[axis][line];
    PageTest& silent = tests.silent;
    Nanos& read = read_[axis][line];
    if (evidence < -kEvidence) read = time;
    if (none_is_known && silent.frames == 0 && evidence <= 0.0) continue;
    const bool falls = evidence > kSuddenEvidence && read != kNever && time - read <= kSudden;
    if (faults.contains(kSupplied[axis], line)) continue;
    if (!faults.contains(kSilent[axis], line)) {
      if (witnesses_.are_doubtful()) silent.restart();
      silent.add(evidence, seen.frame, time);
      tests.is_sudden = falls && !witnesses_.are_doubtful();
      const bool is_decided = silent.decides(kLineFrames);
      if (!tests.is_sudden && !is_decided) continue;
      if (sees(axis, line) && reads_noise_alone(seen, axis, line, faults)) {
        faults.add({.kind = kSilent[axis], .place = line, .frame = silent.first_frame, .time = silent.first_time});
        tests.alive.restart();
      } else if (is_decided) {
        silent.restart();
      }
    } else if (reads_again(tests, seen, axis, line) || is_noise(axis, line)) {
      faults.remove(kSilent[axis], line);
      silent.restart();
    }
  }
}

bool SilentLineDetector::reads_again(LineTests& tests, const Observation& seen, Axis axis,
                                     std::size_t line) const noexcept {
  tests.alive.add(-static_cast<double>(line_evidence_[axis][line]), seen.frame, seen.conditioned.time);
  return tests.alive.decides(tests.is_sudden ? 1 : kHealFrames);
}

/// The line was found since noise has begun that was not known yet, and hides whether the line is silent.
bool SilentLineDetector::is_noise(Axis axis, std::size_t line) const noexcept {
  const bool is_new = tests_[axis][line].silent.first_frame + kNoiseIsKnown >= noise_frame_;
  return last_noise_growth_ > 1.0 && is_new && !sees(axis, line);
}

bool SilentLineDetector::reads_noise_alone(const Observation& seen, Axis axis, std::size_t line,
                                           const FaultList& faults) const noexcept {
  double sum = 0.0;
  double taxels = 0.0;
  for (std::size_t k = 0; k < line_length(array_, axis); ++k) {
    const std::size_t taxel = taxel_on_line(array_, axis, line, k);
    const auto is_witness = static_cast<double>(faults.witnesses(axis)[taxel]);
    sum += is_witness * seen.conditioned.ratio[taxel];
    taxels += is_witness;
  }
  const double most = kMeanOfNoise * taxels + kNoiseSigmas * kDeviationOfNoise * std::sqrt(taxels);
  return sum <= most * seen.conditioned.sigma_ratio;
}

}  // namespace dermis::touch::compensation
