// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/settling.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastShare = 0.003;      // less costs less than the rubber
constexpr double kSigmas = 6.0;            // what must not be chance
constexpr double kLeastRise = 100.0;       // of a pressed reading, over its noise
constexpr std::size_t kLeastPresses = 20;  // of different taxels
constexpr double kSigmasOfMean = 1.2533;   // standard error of a median over that of a mean
constexpr double kSigmasOfDeviation = 1.4826;

/// A frame with its readings in the order of the scan.
struct ScannedFrame {
  ConditionedFrame conditioned;
  std::vector<float> newtons;
};

/// The taxels in the order of the scan.
std::vector<std::size_t> scan_of(const ArrayDescription& array) {
  const std::vector<std::size_t> places = array.order.sent_places(array.order.sent({array.rows, array.cols}));
  std::vector<std::size_t> scan(places.size());
  for (std::size_t k = 0; k < scan.size(); ++k) scan[k] = k;
  std::sort(scan.begin(), scan.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  return scan;
}

std::vector<ScannedFrame> labelled_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                          std::span<const Load> loads) {
  ArrayDescription unsettled = array;
  unsettled.readout.adc_errors.settling.reset();
  touch::preprocessing::Conditioner conditioner(unsettled);
  const LoadsOfFrames loads_of(loads, frames.size());
  std::vector<ScannedFrame> labelled;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (loads_of[k].empty()) continue;
    ScannedFrame frame;
    conditioner.process(frames[k], frame.conditioned);
    if (conditioner.rejection() != touch::preprocessing::Rejection::none) continue;
    Sample sample;
    expand_loads(array, loads_of[k], sample);
    frame.newtons = std::move(sample.known_newtons);
    labelled.push_back(std::move(frame));
  }
  return labelled;
}

/// The only taxel that may be pressed; empty: none or several.
std::optional<std::size_t> only_pressed(const std::vector<float>& newtons) {
  const auto is_pressed = [](float force) { return force != 0.0F; };
  const auto first = std::find_if(newtons.begin(), newtons.end(), is_pressed);
  if (first == newtons.end() || std::any_of(first + 1, newtons.end(), is_pressed)) return std::nullopt;
  return static_cast<std::size_t>(first - newtons.begin());
}

/// Mean ratio of the frames in which nothing presses; empty: there are none.
std::vector<double> idle_ratios(const std::vector<ScannedFrame>& frames, std::size_t taxels) {
  std::vector<double> sum(taxels);
  double count = 0.0;
  for (const auto& [conditioned, newtons] : frames) {
    if (std::any_of(newtons.begin(), newtons.end(), [](float force) { return force != 0.0F; })) continue;
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) sum[taxel] += conditioned.ratio[taxel];
    count += 1.0;
  }
  if (count == 0.0) return {};
  for (double& ratio : sum) ratio /= count;
  return sum;
}

/// Sums for the slope of one taxel's presses.
struct Slope {
  double product = 0.0;
  double square = 0.0;
};

}  // namespace

bool SettlingEstimate::is_significant() const noexcept {
  return share >= kLeastShare && share >= kSigmas * standard_error;
}

std::optional<SettlingEstimate> measure_settling(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                 std::span<const Load> loads) {
  const std::vector<std::size_t> scan = scan_of(array);
  std::vector<std::size_t> place(scan.size());
  for (std::size_t k = 0; k < scan.size(); ++k) place[scan[k]] = k;
  const std::vector<ScannedFrame> labelled = labelled_frames(array, frames, loads);
  const std::vector<double> idle = idle_ratios(labelled, array.taxel_count());
  if (idle.empty()) return std::nullopt;
  std::map<std::size_t, Slope> slopes;  // by taxel: its presses have the same rubber beside them
  for (const auto& [conditioned, newtons] : labelled) {
    const std::optional<std::size_t> pressed = only_pressed(newtons);
    if (!pressed || place[*pressed] == 0 || place[*pressed] + 1 == scan.size()) continue;
    const std::size_t before = scan[place[*pressed] - 1];
    const std::size_t behind = scan[place[*pressed] + 1];
    const auto is_bad = [&](std::size_t taxel) { return conditioned.taxels[taxel] != TaxelStatus::ok; };
    if (is_bad(before) || is_bad(*pressed) || is_bad(behind)) continue;
    const auto rise = [&](std::size_t taxel) { return conditioned.ratio[taxel] - idle[taxel]; };
    if (rise(*pressed) < kLeastRise * conditioned.sigma_ratio) continue;
    slopes[*pressed].product += (rise(behind) - rise(before)) * rise(*pressed);
    slopes[*pressed].square += rise(*pressed) * rise(*pressed);
  }
  if (slopes.size() < kLeastPresses) return std::nullopt;
  std::vector<double> shares;
  for (const auto& [taxel, slope] : slopes) shares.push_back(slope.product / slope.square);
  SettlingEstimate estimate{quantile(shares, 0.5), 0.0};
  std::vector<double> deviations;
  for (const double share : shares) deviations.push_back(std::abs(share - estimate.share));
  estimate.standard_error =
      kSigmasOfMean * kSigmasOfDeviation * quantile(deviations, 0.5) / std::sqrt(static_cast<double>(shares.size()));
  return estimate;
}

}  // namespace dermis::learn::calibration
