// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/frame_sums.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostForLevel = 101;  // frames

std::uint32_t strongest_taxel(const std::vector<double>& ratio, const std::vector<double>& levels) {
  std::size_t strongest = 0;
  for (std::size_t taxel = 1; taxel < ratio.size(); ++taxel) {
    if (ratio[taxel] - levels[taxel] > ratio[strongest] - levels[strongest]) strongest = taxel;
  }
  return static_cast<std::uint32_t>(strongest);
}

}  // namespace

std::vector<double> unloaded_levels(const ArrayDescription& array, std::span<const RawFrame> frames,
                                    std::span<const std::optional<double>> newtons) {
  const auto unloaded =
      static_cast<std::size_t>(std::count(newtons.begin(), newtons.end(), std::optional<double>(0.0)));
  const std::size_t stride = unloaded / kMostForLevel + 1;
  std::vector<std::vector<double>> ratios(array.taxel_count());
  ConditionedFrame conditioned;
  std::size_t seen = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (newtons[k] != 0.0 || seen++ % stride != 0) continue;
    touch::preprocessing::Conditioner conditioner(array);
    conditioner.process(frames[k], conditioned);
    if (conditioner.rejection() != touch::preprocessing::Rejection::none) continue;
    for (std::size_t taxel = 0; taxel < ratios.size(); ++taxel) ratios[taxel].push_back(conditioned.ratio[taxel]);
  }
  std::vector<double> levels;
  for (std::vector<double>& of_taxel : ratios) {
    levels.push_back(of_taxel.empty() ? 0.0 : upper_median(std::move(of_taxel)));
  }
  return levels;
}

std::vector<FrameSum> sum_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                 std::span<const Load> loads, Nanos settle_time) {
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  const std::vector<double> levels = unloaded_levels(array, frames, newtons);
  touch::preprocessing::Conditioner conditioner(array);
  ConditionedFrame conditioned;
  std::vector<FrameSum> sums;
  sums.reserve(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (frames[k].time - frames.front().time < settle_time) continue;
    conditioner.process(frames[k], conditioned);
    if (conditioner.rejection() != touch::preprocessing::Rejection::none) continue;
    FrameSum sum;
    sum.ratio = std::reduce(conditioned.ratio.begin(), conditioned.ratio.end());
    sum.sigma = conditioned.sigma_ratio * std::sqrt(static_cast<double>(array.taxel_count()));
    sum.newtons = newtons[k].value_or(kUnknown);
    sum.celsius = conditioned.temperature_celsius.value_or(kUnknown);
    sum.frame = static_cast<std::uint32_t>(k);
    sum.strongest = strongest_taxel(conditioned.ratio, levels);
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace dermis::learn::calibration
