// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "dermis/learn/arrangement/press_finder.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::arrangement {
namespace {

using Frames = std::span<const RawFrame>;

constexpr double kStretchSeconds = 0.25;
constexpr std::size_t kFewest = 8;           // frames of a stretch
constexpr double kStrong = 0.8;              // of the stretches are weaker
constexpr double kPressed = 0.5;             // of the typical change: more than crosstalk
constexpr std::size_t kFirstStretches = 32;  // 8 s

std::size_t frames_of_stretch(Frames frames) {
  const double seconds = std::chrono::duration<double>(frames.back().time - frames.front().time).count();
  const double rate = seconds > 0.0 ? static_cast<double>(frames.size() - 1) / seconds : 0.0;
  const auto wanted = static_cast<std::size_t>(std::clamp(rate * kStretchSeconds, 0.0, 1e6));
  return std::min(std::max(wanted, kFewest), frames.size());
}

/// The rest of each stretch by itself.
std::vector<Rest> rests_of(Frames frames, std::size_t length) {
  std::vector<Rest> rests;
  for (std::size_t first = 0; first + length <= frames.size(); first += length) {
    std::vector<std::vector<float>> stretch;
    for (const RawFrame& frame : frames.subspan(first, length)) stretch.push_back(frame.counts);
    rests.push_back(rest_of(stretch));
  }
  return rests;
}

/// For each channel, the median over all stretches: few of them have a press of it.
Rest usual_of(const std::vector<Rest>& rests) {
  Rest usual = rests.front();
  std::vector<float> values(rests.size());
  for (std::size_t i = 0; i < usual.level.size(); ++i) {
    std::transform(rests.begin(), rests.end(), values.begin(), [i](const Rest& rest) { return rest.level[i]; });
    usual.level[i] = upper_median(values);
    std::transform(rests.begin(), rests.end(), values.begin(), [i](const Rest& rest) { return rest.noise[i]; });
    usual.noise[i] = upper_median(values);
  }
  return usual;
}

double difference(const Rest& a, const Rest& b, std::size_t channel) {
  return std::abs(static_cast<double>(a.level[channel] - b.level[channel]));
}

/// By a press: nearly the strongest stretches show it.
double typical_change(const std::vector<Rest>& rests, const Rest& usual) {
  std::vector<double> most(rests.size());
  for (std::size_t k = 0; k < rests.size(); ++k)
    for (std::size_t i = 0; i < usual.level.size(); ++i) most[k] = std::max(most[k], difference(rests[k], usual, i));
  const auto strong = static_cast<std::size_t>(kStrong * static_cast<double>(most.size() - 1));
  return ranked(std::move(most), strong);
}

/// As the recording begins; a channel that is pressed then has what is usual in the first seconds.
Rest first_rest(const std::vector<Rest>& rests, const Rest& usual, double typical) {
  const std::size_t some = std::min(kFirstStretches, rests.size());
  const Rest early = usual_of({rests.begin(), rests.begin() + static_cast<std::ptrdiff_t>(some)});
  Rest rest{rests.front().level, usual.noise};
  for (std::size_t i = 0; i < rest.level.size(); ++i) {
    // Drift makes it unlike the one, and a long press after it unlike the other.
    const double unlike = std::min(difference(rests.front(), early, i), difference(rests.front(), usual, i));
    if (unlike > kPressed * typical) rest.level[i] = early.level[i];
  }
  return rest;
}

}  // namespace

std::vector<Press> find_presses(Frames frames) {
  if (frames.empty() || frames.front().counts.empty()) return {};
  const std::vector<Rest> rests = rests_of(frames, frames_of_stretch(frames));
  const Rest usual = usual_of(rests);
  const double typical = typical_change(rests, usual);
  PressFinder finder(first_rest(rests, usual, typical), typical);
  std::vector<Press> presses;
  const auto take = [&](std::optional<Press> press) {
    if (!press) return;
    press->begin -= frames.front().time;
    press->end -= frames.front().time;
    presses.push_back(*press);
  };
  for (const RawFrame& frame : frames) take(finder.add(frame.counts, frame.time));
  take(finder.finish());
  return presses;
}

}  // namespace dermis::learn::arrangement
