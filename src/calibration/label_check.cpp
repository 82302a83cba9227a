// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/label_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "calibration/frame_sums.hpp"
#include "calibration/label_shift.hpp"
#include "calibration/labels.hpp"
#include "dermis/calibration/sample_temperatures.hpp"
#include "dermis/core/quantile.hpp"

namespace dermis::calibration {
namespace {

constexpr double kSigmasPerMedianDeviation = 1.4826;  // of Gaussian noise
constexpr double kHuberSigmas = 1.345;                // 95 % of the efficiency of least squares (Huber 1964)
constexpr int kHuberRounds = 30;
constexpr std::size_t kLeastUnloaded = 5;  // frames, for a majority
constexpr double kPressedSigmas = 6.0;
constexpr double kPressedShare = 0.005;  // of what a typical load reads
constexpr double kMostPascal = 5e6;

// ------------------------------------------------------------------------------------------------- unloaded frames

/// What the array reads unloaded, as most of the frames that are called so say.
struct UnloadedSum {
  double level = 0.0;  // at 0 C where there is a slope
  double per_celsius = 0.0;
  double sigma = 0.0;

  [[nodiscard]] double excess(const FrameSum& sum) const {
    return sum.ratio - level - (per_celsius != 0.0 ? per_celsius * sum.celsius : 0.0);
  }
};

double median_deviation(const std::vector<const FrameSum*>& sums, const UnloadedSum& unloaded) {
  std::vector<double> deviations;
  for (const FrameSum* sum : sums) deviations.push_back(std::abs(unloaded.excess(*sum)));
  return kSigmasPerMedianDeviation * upper_median(std::move(deviations));
}

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

/// Least squares in which what lies further off counts by its distance, not the square of it (Huber 1964).
UnloadedSum fit_unloaded_sum(const std::vector<const FrameSum*>& sums) {
  UnloadedSum fit;
  std::vector<double> ratios;
  double least_sigma = 0.0;
  for (const FrameSum* sum : sums) {
    ratios.push_back(sum->ratio);
    least_sigma = std::max(least_sigma, sum->sigma);
  }
  const bool has_slope = span_temperatures(sums);
  fit.level = upper_median(std::move(ratios));
  for (int round = 0; has_slope && round < kHuberRounds; ++round) {
    const double limit = kHuberSigmas * std::max(median_deviation(sums, fit), least_sigma);
    double weights = 0.0;
    double celsius = 0.0;
    double ratio = 0.0;
    double variance = 0.0;
    double covariance = 0.0;
    for (const FrameSum* sum : sums) {  // West 1979: means and moments in one pass
      const double weight = limit / std::max(limit, std::abs(fit.excess(*sum)));
      weights += weight;
      const double from_mean = sum->celsius - celsius;
      celsius += weight / weights * from_mean;
      ratio += weight / weights * (sum->ratio - ratio);
      variance += weight * from_mean * (sum->celsius - celsius);
      covariance += weight * from_mean * (sum->ratio - ratio);
    }
    fit.per_celsius = covariance / variance;
    fit.level = ratio - fit.per_celsius * celsius;
  }
  fit.sigma = std::max(median_deviation(sums, fit), least_sigma);
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

// ------------------------------------------------------------------------------------------------------------ units

std::optional<std::string> remark_on_units(const ArrayDescription& array, std::span<const Load> loads) {
  const double area = array.taxel_area_m2.value_or(array.row_pitch_m * array.col_pitch_m);
  const auto pascal = [&](const Load& load) {
    return total_newtons(load, array) / (area * static_cast<double>(load.where.taxel_count()));
  };
  const auto heaviest =
      std::max_element(loads.begin(), loads.end(), [&](const Load& a, const Load& b) { return pascal(a) < pascal(b); });
  if (pascal(*heaviest) <= kMostPascal) return std::nullopt;
  return fmt::format(
      "the load of frame {} presses {} with {:.3g} MPa: is it in newtons (or kPa), not in grams (or Pa)?",
      heaviest->frame, to_string(heaviest->where, array), 1e-6 * pascal(*heaviest));
}

}  // namespace

LabelCheck check_labels(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                        Nanos settle_time) {
  LabelCheck check;
  const std::vector<FrameSum> sums = sum_frames(array, frames, loads, settle_time);
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
  if (auto remark = remark_on_units(array, loads)) check.remarks.push_back(*std::move(remark));
  return check;
}

}  // namespace dermis::calibration
