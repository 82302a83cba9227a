// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/rail_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastAtRail = 10;  // readings
constexpr double kLeastLoadRange = 2.0;   // heaviest over lightest load that drives readings to the rail
constexpr double kBandSigmas = 10.0;      // before the rail

/// Rising with pressure [counts]; NaN where there is no reading.
double pressed_counts(const Readout& readout, float count) {
  const auto counts = static_cast<double>(count);
  const double full_scale = readout.full_scale_counts();
  if (!(counts >= 0.0 && counts <= full_scale)) return std::numeric_limits<double>::quiet_NaN();
  return readout.pressure_raises_reading ? counts : full_scale - counts;
}

}  // namespace

std::optional<double> find_rail(const ArrayDescription& array, std::span<const RawFrame> frames,
                                std::span<const Load> loads) {
  const Readout& readout = array.readout;
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  const auto for_each_reading = [&](auto visit) {
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      if (!newtons[frame]) continue;
      const std::vector<float>& counts = frames[frame].counts;
      for (std::size_t taxel = 0; taxel < std::min(counts.size(), array.taxel_count()); ++taxel) {
        if (!array.is_absent(taxel)) visit(*newtons[frame], pressed_counts(readout, counts[taxel]));
      }
    }
  };
  double rail = 0.0;
  for_each_reading([&](double, double counts) { rail = counts > rail ? counts : rail; });
  if (rail >= readout.full_scale_counts()) return std::nullopt;

  std::size_t at_rail = 0;
  std::size_t before_rail = 0;
  double lightest = std::numeric_limits<double>::infinity();
  double heaviest = 0.0;
  for_each_reading([&](double load, double counts) {
    if (counts == rail) {
      ++at_rail;
      lightest = std::min(lightest, load);
      heaviest = std::max(heaviest, load);
    } else if (counts > rail - kBandSigmas * readout.adc_noise_counts) {
      ++before_rail;
    }
  });
  const bool is_rail =
      at_rail >= kLeastAtRail && at_rail > before_rail && lightest > 0.0 && heaviest >= kLeastLoadRange * lightest;
  if (!is_rail) return std::nullopt;
  return readout.pressure_raises_reading ? rail : readout.full_scale_counts() - rail;
}

}  // namespace dermis::learn::calibration
