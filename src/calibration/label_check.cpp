// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/label_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "calibration/labels.hpp"
#include "dermis/calibration/sample_temperatures.hpp"
#include "dermis/core/quantile.hpp"
#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::calibration {
namespace {

constexpr double kSigmasPerMedianDeviation = 1.4826;  // of Gaussian noise
constexpr double kHuberSigmas = 1.345;                // 95 % of the efficiency of least squares (Huber 1964)
constexpr int kHuberRounds = 30;
constexpr std::size_t kLeastUnloaded = 5;  // frames, for a majority
constexpr double kPressedSigmas = 6.0;
constexpr double kPressedShare = 0.005;  // of what a typical load reads
constexpr std::ptrdiff_t kMostShift = 10;
constexpr std::size_t kLeastForShift = 20;  // frames
constexpr double kClearCorrelation = 0.5;
constexpr double kPoorCorrelation = 0.9;
constexpr double kMostPascal = 5e6;

/// A frame with all its taxels in one number.
struct FrameSum {
  std::size_t frame = 0;
  double ratio = 0.0;             // sum over the taxels
  double sigma = 0.0;             // of the sum, by the noise of the array's description
  std::optional<double> newtons;  // total; none: not labelled
  std::optional<double> temperature_celsius;
};

/// Of all frames after settling that are not rejected.
std::vector<FrameSum> sum_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                 std::span<const Load> loads, Nanos settle_time) {
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  preprocessing::Conditioner conditioner(array);
  ConditionedFrame conditioned;
  std::vector<FrameSum> sums;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (frames[k].time - frames.front().time < settle_time) continue;
    conditioner.process(frames[k], conditioned);
    if (conditioner.rejection() != preprocessing::Rejection::none) continue;
    const double ratio = std::reduce(conditioned.ratio.begin(), conditioned.ratio.end());
    const double sigma = conditioned.sigma_ratio * std::sqrt(static_cast<double>(array.taxel_count()));
    sums.push_back({k, ratio, sigma, newtons[k], conditioned.temperature_celsius});
  }
  return sums;
}

// ------------------------------------------------------------------------------------------------- unloaded frames

/// What the array reads unloaded, as most of the frames that are called so say.
struct UnloadedSum {
  double level = 0.0;  // at 0 C where there is a slope
  double per_celsius = 0.0;
  double sigma = 0.0;

  [[nodiscard]] double excess(const FrameSum& sum) const {
    return sum.ratio - level - per_celsius * sum.temperature_celsius.value_or(0.0);
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
    if (!sum->temperature_celsius) return false;
    lowest = std::min(lowest, *sum->temperature_celsius);
    highest = std::max(highest, *sum->temperature_celsius);
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
      const double from_mean = *sum->temperature_celsius - celsius;
      celsius += weight / weights * from_mean;
      ratio += weight / weights * (sum->ratio - ratio);
      variance += weight * from_mean * (*sum->temperature_celsius - celsius);
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

// --------------------------------------------------------------------------------------------------- shifted labels

/// Places of the values when they rise, from -1 to 1; equal values share theirs.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    const double place = static_cast<double>(first + last) / static_cast<double>(order.size()) - 1.0;
    for (; first < last; ++first) rank[order[first]] = place;
  }
  return rank;
}

double correlation(const std::vector<std::pair<double, double>>& pairs) {
  double x = 0.0;
  double y = 0.0;
  for (const auto& [a, b] : pairs) {
    x += a / static_cast<double>(pairs.size());
    y += b / static_cast<double>(pairs.size());
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const auto& [a, b] : pairs) {
    xx += (a - x) * (a - x);
    xy += (a - x) * (b - y);
    yy += (b - y) * (b - y);
  }
  return xx * yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
}

/// Rank correlation of the loads with the readings so many frames later.
class ShiftedLabels {
 public:
  explicit ShiftedLabels(const std::vector<FrameSum>& sums) : sums_(sums) {
    std::vector<double> ratios;
    std::vector<double> newtons;
    for (const FrameSum& sum : sums) {
      ratios.push_back(sum.ratio);
      newtons.push_back(sum.newtons.value_or(-1.0));
    }
    readings_ = ranks(ratios);
    loads_ = ranks(newtons);
  }

  [[nodiscard]] double correlation_at(std::ptrdiff_t shift) const {
    std::vector<std::pair<double, double>> pairs;
    const auto size = static_cast<std::ptrdiff_t>(sums_.size());
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(-shift, 0); k < std::min(size, size - shift); ++k) {
      const auto labelled = static_cast<std::size_t>(k);
      if (sums_[labelled].newtons) pairs.emplace_back(loads_[labelled], readings_[static_cast<std::size_t>(k + shift)]);
    }
    return pairs.size() < kLeastForShift ? 0.0 : correlation(pairs);
  }

 private:
  const std::vector<FrameSum>& sums_;
  std::vector<double> readings_;
  std::vector<double> loads_;
};

std::optional<std::string> remark_on_shift(const std::vector<FrameSum>& sums) {
  const ShiftedLabels labels(sums);
  const double now = labels.correlation_at(0);
  if (now > kPoorCorrelation) return std::nullopt;
  std::ptrdiff_t best = 0;
  double highest = now;
  for (std::ptrdiff_t shift = -kMostShift; shift <= kMostShift; ++shift) {
    const double shifted = labels.correlation_at(shift);
    if (shifted <= highest) continue;
    highest = shifted;
    best = shift;
  }
  if (highest < kClearCorrelation || 2.0 * (1.0 - highest) > 1.0 - now) return std::nullopt;
  return fmt::format(
      "the loads fit the readings {} frame{} {} (rank correlation {:.2f}, as labelled {:.2f}): check them",
      std::abs(best), std::abs(best) == 1 ? "" : "s", best > 0 ? "later" : "earlier", highest, now);
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
    if (sum.newtons) (*sum.newtons > 0.0 ? loaded : unloaded).push_back(&sum);
  }
  const std::vector<std::size_t> pressed = pressed_frames(unloaded, loaded);
  const auto is_pressed = [&](std::size_t frame) { return std::binary_search(pressed.begin(), pressed.end(), frame); };
  std::copy_if(loads.begin(), loads.end(), std::back_inserter(check.loads),
               [&](const Load& load) { return !is_pressed(load.frame); });
  if (!pressed.empty()) {
    check.remarks.push_back(fmt::format("{} of {} unloaded frames are pressed: left out, the first {}", pressed.size(),
                                        unloaded.size(), pressed.front()));
  }
  if (const auto remark = remark_on_shift(sums)) check.remarks.push_back(*remark);
  if (const auto remark = remark_on_units(array, loads)) check.remarks.push_back(*remark);
  return check;
}

}  // namespace dermis::calibration
