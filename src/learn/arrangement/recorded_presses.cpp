// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "dermis/learn/arrangement/press_finder.hpp"
#include "learn/arrangement/median.hpp"

namespace dermis::learn::arrangement {
namespace {

using Frames = std::span<const RawFrame>;

constexpr double kStretch_s = 0.25;
constexpr std::size_t kFewest = 8;        // frames of a stretch
constexpr double kMostDeviations = 20.0;  // that one channel has of a say

std::size_t frames_of_stretch(Frames frames) {
  const double seconds = std::chrono::duration<double>(frames.back().time - frames.front().time).count();
  const double rate = seconds > 0.0 ? static_cast<double>(frames.size() - 1) / seconds : 0.0;
  const auto wanted = static_cast<std::size_t>(std::clamp(rate * kStretch_s, 0.0, 1e6));
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
    usual.level[i] = median_of(values);
    std::transform(rests.begin(), rests.end(), values.begin(), [i](const Rest& rest) { return rest.noise[i]; });
    usual.noise[i] = median_of(values);
  }
  return usual;
}

/// How far a stretch is from what is usual, and how much it moves.
double unrest_of(const Rest& rest, const Rest& usual) {
  double unrest = 0.0;
  for (std::size_t i = 0; i < rest.level.size(); ++i) {
    const auto noise = static_cast<double>(usual.noise[i]);
    unrest += std::min(std::abs(static_cast<double>(rest.level[i] - usual.level[i])) / noise, kMostDeviations);
    unrest += std::min(static_cast<double>(rest.noise[i]) / noise, kMostDeviations);
  }
  return unrest;
}

/// Away from the quiet stretch, in the order in which `frame(k)` gives the frames.
template <typename FrameAt>
std::vector<Press> presses_from(const Rest& rest, std::size_t count, const FrameAt& frame) {
  PressFinder finder(rest);
  std::vector<Press> presses;
  const auto take = [&](const std::optional<Press>& press) {
    if (press) presses.push_back(*press);
  };
  for (std::size_t k = 0; k < count; ++k) take(finder.add(frame(k).counts, frame(k).time));
  take(finder.finish());
  return presses;
}

}  // namespace

std::vector<Press> find_presses(Frames frames) {
  if (frames.empty() || frames.front().counts.empty()) return {};
  const std::size_t length = frames_of_stretch(frames);
  const std::vector<Rest> rests = rests_of(frames, length);
  const Rest usual = usual_of(rests);
  std::vector<double> unrest(rests.size());
  std::transform(rests.begin(), rests.end(), unrest.begin(), [&](const Rest& rest) { return unrest_of(rest, usual); });
  const auto quiet = static_cast<std::size_t>(std::min_element(unrest.begin(), unrest.end()) - unrest.begin());
  const Rest rest{rests[quiet].level, usual.noise};
  const std::size_t first = quiet * length;
  const std::size_t last = first + length;
  std::vector<Press> presses =
      presses_from(rest, last, [&](std::size_t k) -> const RawFrame& { return frames[last - 1 - k]; });
  std::reverse(presses.begin(), presses.end());
  for (Press& press : presses) std::swap(press.begin, press.end);
  const std::vector<Press> later =
      presses_from(rest, frames.size() - first, [&](std::size_t k) -> const RawFrame& { return frames[first + k]; });
  presses.insert(presses.end(), later.begin(), later.end());
  for (Press& press : presses) {
    press.begin -= frames.front().time;
    press.end -= frames.front().time;
  }
  return presses;
}

}  // namespace dermis::learn::arrangement
