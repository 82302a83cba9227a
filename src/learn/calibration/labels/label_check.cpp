// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/label_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/labels/frame_sums.hpp"
#include "learn/calibration/labels/label_shift.hpp"
#include "learn/calibration/labels/labels.hpp"
#include "learn/calibration/labels/turned_lines.hpp"
#include "learn/calibration/labels/unit_check.hpp"
#include "learn/calibration/robust_line.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr int kHuberRounds = 30;
constexpr std::size_t kLeastUnloaded = 5;  // frames, for a majority
constexpr double kPressedSigmas = 6.0;
constexpr double kPressedShare = 0.005;  // of what a typical load reads

/// The unloaded sum of the array by most of the frames that are called so; at 0 C where there is a slope.
struct UnloadedSum {
  RobustLine line;
  double sigma = 0.0;

  [[nodiscard]] double excess(const FrameSum& sum) const {
    return line.residual({line.slope != 0.0 ? sum.celsius : 0.0, sum.ratio});
  }
};

bool span_temperatures(const std::vector<const FrameSum*>& sums) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const FrameSum* sum : sums) {
    if (std::isnan(sum->celsius)) return false;
    lowest = std::min(lowest, sum->celsius);
    highest = std::max(highest, sum->celsius);
  }
  return highest - lowest >= SampleTemperatures::kLeastSpanCelsius;
}

UnloadedSum fit_unloaded_sum(const std::vector<const FrameSum*>& sums) {
  const bool has_slope = span_temperatures(sums);
  std::vector<Point> points;
  std::vector<double> ratios;
  double least_sigma = 0.0;
  for (const FrameSum* sum : sums) {
    points.push_back({has_slope ? sum->celsius : 0.0, sum->ratio});
    ratios.push_back(sum->ratio);
    least_sigma = std::max(least_sigma, sum->sigma);
  }
  UnloadedSum fit;
  fit.line.level = upper_median(std::move(ratios));
  for (int round = 0; has_slope && round < kHuberRounds; ++round) {
    const double limit = kHuberSigmas * std::max(median_deviation(points, fit.line), least_sigma);
    fit.line = huber_step(points, fit.line, limit);
  }
  fit.sigma = std::max(median_deviation(points, fit.line), least_sigma);
  return fit;
}

/// Frames that are called unloaded and read like pressed ones, in order.
std::vector<std::size_t> pressed_frames(const std::vector<const FrameSum*>& unloaded,
                                        const std::vector<const FrameSum*>& loaded) {
  if (unloaded.size() < kLeastUnloaded || loaded.empty()) return {};
  const UnloadedSum fit = fit_unloaded_sum(unloaded);
  std::vector<double> excess;
  for (const FrameSum* sum : loaded) excess.push_back(fit.excess(*sum));
  const double limit = std::max(kPressedSigmas * fit.sigma, kPressedShare * upper_median(std::move(excess)));
  std::vector<std::size_t> pressed;
  for (const FrameSum* sum : unloaded) {
    if (fit.excess(*sum) > limit) pressed.push_back(sum->frame);
  }
  return pressed;
}

}  // namespace

LabelCheck check_labels(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                        Nanos settle_time) {
  LabelCheck check;
  const std::vector<FrameSum> sums = sum_frames(array, frames, loads, settle_time);
  check.turn = find_turn(array, sums, loads);
  std::vector<const FrameSum*> unloaded;
  std::vector<const FrameSum*> loaded;
  for (const FrameSum& sum : sums) {
    if (sum.is_labelled()) (sum.newtons > 0.0 ? loaded : unloaded).push_back(&sum);
  }
  check.pressed_frames = pressed_frames(unloaded, loaded);
  if (!check.pressed_frames.empty()) {
    check.remarks.push_back(fmt::format("{} of {} unloaded frames are pressed: left out, the first {}",
                                        check.pressed_frames.size(), unloaded.size(), check.pressed_frames.front()));
  }
  const LoadsOfFrames loads_of(loads, frames.size());
  if (auto remark = remark_on_shift(sums, loads_of, array)) check.remarks.push_back(*std::move(remark));
  if (auto remark = remark_on_units(array, frames, loads)) check.remarks.push_back(*std::move(remark));
  return check;
}

}  // namespace dermis::learn::calibration
