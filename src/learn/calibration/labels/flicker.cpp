// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/flicker.hpp"

#include <algorithm>
#include <optional>

#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kJumpShare = 0.05;  // of full scale
constexpr double kJumpSigmas = 20.0;
constexpr std::size_t kLeastFrames = 8;  // unloaded ones between unloaded ones
constexpr std::size_t kLeastReversals = 3;
constexpr double kReversedShare = 0.1;      // of the frames
constexpr std::size_t kTaxelsForEach = 20;  // that flickers

/// The reading of the middle frame is far above those before and after it, or far below.
bool is_reversal(float before, float middle, float after, double jump) {
  const double from = static_cast<double>(middle) - static_cast<double>(before);
  const double to = static_cast<double>(middle) - static_cast<double>(after);
  return (from > jump && to > jump) || (from < -jump && to < -jump);
}

}  // namespace

std::vector<std::size_t> find_flickering_taxels(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                std::span<const Load> loads) {
  const Readout& readout = array.readout;
  if (readout.quantity != Quantity::counts) return {};
  const std::size_t taxels = array.taxel_count();
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  const auto is_unloaded = [&](std::size_t k) { return newtons[k] == 0.0 && frames[k].counts.size() == taxels; };
  const double jump = std::max(kJumpShare * readout.full_scale_counts(), kJumpSigmas * readout.adc_noise_counts);
  std::vector<std::size_t> reversals(taxels);
  std::size_t compared = 0;
  for (std::size_t k = 1; k + 1 < frames.size(); ++k) {
    if (!is_unloaded(k - 1) || !is_unloaded(k) || !is_unloaded(k + 1)) continue;
    ++compared;
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      const bool reversed =
          is_reversal(frames[k - 1].counts[taxel], frames[k].counts[taxel], frames[k + 1].counts[taxel], jump);
      reversals[taxel] += reversed ? 1 : 0;
    }
  }
  if (compared < kLeastFrames) return {};
  std::vector<std::size_t> flickering;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const bool is_often = static_cast<double>(reversals[taxel]) >= kReversedShare * static_cast<double>(compared);
    if (is_often && reversals[taxel] >= kLeastReversals && !array.is_absent(taxel)) flickering.push_back(taxel);
  }
  if (kTaxelsForEach * flickering.size() > taxels + kTaxelsForEach - 1) return {};
  if (flickering.size() + array.absent.size() >= taxels) return {};
  return flickering;
}

}  // namespace dermis::learn::calibration
