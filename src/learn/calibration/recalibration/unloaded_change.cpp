// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/recalibration/unloaded_change.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/frames/touch.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kTouchedSigmas = 5.0;
constexpr double kLeastChange = 0.02;
constexpr std::size_t kLeastTaxels = 10;
constexpr std::size_t kLeastFrames = 10;
constexpr double kMostAveraged = 25.0;  // not all noise is white

}  // namespace

void UnloadedChange::add(touch::pipeline::Pipeline& pipeline) {
  const ConductanceFrame& frame = pipeline.conductance();
  if (frame.status != FrameStatus::ok) return;
  std::size_t taxels = 0;
  double expected_sum = 0.0;
  double sum = 0.0;
  for (std::size_t taxel = 0; taxel < frame.siemens.size(); ++taxel) {
    const double expected = calibrated_.at(taxel, calibrated_.temperature.offset(frame.celsius(taxel)));
    const double siemens = frame.siemens[taxel] + pipeline.drift().offsets()[taxel];
    const double sigma = frame.sigma_siemens[taxel];
    if (frame.taxels[taxel] != TaxelStatus::ok) continue;
    if (siemens > touched_above(std::max(expected, 0.0), sigma, kTouchedSigmas)) return;
    if (!(expected > kSigmas * sigma)) continue;
    ++taxels;
    expected_sum += expected;
    sum += siemens;
  }
  if (taxels < kLeastTaxels) return;
  const double change = sum / expected_sum - 1.0;
  ++frames_;
  sum_ += change;
  squares_ += change * change;
}

double UnloadedChange::change() const {
  if (frames_ < kLeastFrames) return 0.0;
  const auto frames = static_cast<double>(frames_);
  const double mean = sum_ / frames;
  const double variance = std::max(squares_ / frames - mean * mean, 0.0);
  const double sigma = std::sqrt(variance / std::min(frames, kMostAveraged));
  const bool is_sure = std::abs(mean) > std::max(kSigmas * sigma, kLeastChange);
  return is_sure && std::abs(mean) < touch::compensation::kMostDriftOfUnloaded ? mean : 0.0;
}

}  // namespace dermis::learn::calibration
