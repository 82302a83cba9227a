// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/press_finder.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::arrangement {
namespace {

constexpr double kNoises = 6.0;               // a press is so many deviations from rest,
constexpr double kOfTypical = 0.1;            // and this share of the presses before it
constexpr double kReleased = 0.45;            // of its own peak
constexpr double kRises = 0.15;               // of the last peak, where the array still remembers it
constexpr double kForgotten = 0.5;            // of what would be a press
constexpr double kShortestSeconds = 0.03;     // and two frames
constexpr double kBetweenSeconds = 0.1;       // and two frames: less is a finger that wobbles
constexpr double kLongestSeconds = 15.0;      // more is no press, but another rest,
constexpr double kFaintLongestSeconds = 2.0;  // and sooner
constexpr double kFaint = 0.4;                // below this share of the presses before it
constexpr double kFollowsSeconds = 1.0;       // time constant of the rest,
constexpr double kForgetsSeconds = 0.3;       // and after a press
constexpr double kLongestStepSeconds = 1.0;   // between two frames, as far as times are believed
constexpr std::size_t kTogether = 5;          // channels of which most may move together
constexpr float kOfLevel = 1e-3F;             // least noise, by the level,
constexpr float kCount = 0.7F;                // and where readings are whole numbers
constexpr float kLeast = 1e-9F;
constexpr float kSigmasOfDeviation = 1.4826F;

bool is_whole(std::span<const std::vector<float>> frames) {
  return std::all_of(frames.begin(), frames.end(), [](const std::vector<float>& frame) {
    return std::all_of(frame.begin(), frame.end(), [](float x) { return !std::isfinite(x) || x == std::round(x); });
  });
}

/// Clocks may step back.
double seconds_between(Nanos one, Nanos other) {
  return std::abs(std::chrono::duration<double>(other - one).count());
}

float middle_of(float a, float b, float c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

}  // namespace

Rest rest_of(std::span<const std::vector<float>> frames) {
  assert(!frames.empty());
  const std::size_t channels = frames.front().size();
  const float least = is_whole(frames) ? kCount : kLeast;
  Rest rest{std::vector<float>(channels), std::vector<float>(channels)};
  std::vector<float> readings;
  for (std::size_t i = 0; i < channels; ++i) {
    readings.clear();
    for (const std::vector<float>& frame : frames)
      if (std::isfinite(frame[i])) readings.push_back(frame[i]);
    if (!readings.empty()) rest.level[i] = upper_median(readings);
    for (float& reading : readings) reading = std::abs(reading - rest.level[i]);
    const float deviation = readings.empty() ? 0.0F : kSigmasOfDeviation * upper_median(readings);
    rest.noise[i] = std::max({deviation, least, kOfLevel * std::abs(rest.level[i])});
  }
  return rest;
}

PressFinder::PressFinder(Rest rest, double typical)
    : rest_(std::move(rest)),
      recent_{rest_.level, rest_.level, rest_.level},
      change_(rest_.level.size()),
      typical_(typical) {}

void PressFinder::filter(std::span<const float> counts) {
  assert(counts.size() == change_.size());
  auto& [earlier, last, filtered] = recent_;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const float now = std::isfinite(counts[i]) ? counts[i] : last[i];
    filtered[i] = middle_of(earlier[i], last[i], now);
    earlier[i] = std::exchange(last[i], now);
  }
}

/// By the rest, less what all channels do together.
void PressFinder::find_changes() {
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] = recent_.filtered[i] - rest_.level[i];
  if (change_.size() < kTogether) return;
  const float together = upper_median(change_);
  for (float& change : change_) change -= together;
}

double PressFinder::threshold(std::size_t channel) const {
  return std::max(kNoises * static_cast<double>(rest_.noise[channel]), kOfTypical * typical_);
}

std::size_t PressFinder::strongest() const {
  std::size_t strongest = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < change_.size(); ++i) {
    const double beyond = std::abs(static_cast<double>(change_[i])) - kNoises * static_cast<double>(rest_.noise[i]);
    if (beyond <= most) continue;
    most = beyond;
    strongest = i;
  }
  return strongest;
}

/// The rest goes with what drifts.
void PressFinder::follow(double seconds) {
  const auto share = static_cast<float>(1.0 - std::exp(-seconds / (remembers_ ? kForgetsSeconds : kFollowsSeconds)));
  for (std::size_t i = 0; i < change_.size(); ++i) rest_.level[i] += share * (recent_.filtered[i] - rest_.level[i]);
}

void PressFinder::begin(double change) {
  is_pressed_ = true;
  remembers_ = false;
  held_ = {.sums = std::vector<double>(change_.size()), .peak = change, .begin = *time_};
}

/// Changes while the press is strong count most.
void PressFinder::gather(double change, double seconds) {
  held_.peak = std::max(held_.peak, change);
  if (change < kReleased * held_.peak) {
    if (held_.low_frames == 0) held_.low_since = *time_;
    held_.low_seconds += held_.low_frames > 0 ? seconds : 0.0;
    ++held_.low_frames;
    return;
  }
  held_.frames += 1 + held_.low_frames;
  held_.low_frames = 0;
  held_.low_seconds = 0.0;
  const double weight = change * change;
  held_.weight += weight;
  for (std::size_t i = 0; i < change_.size(); ++i) held_.sums[i] += weight * static_cast<double>(change_[i]);
}

/// The channels that changed most beyond what noise does to a mean.
Press PressFinder::answer() const {
  const double noises = kNoises / std::sqrt(static_cast<double>(held_.frames));
  const auto score = [&](std::size_t i) {
    return std::abs(held_.sums[i] / held_.weight) - noises * static_cast<double>(rest_.noise[i]);
  };
  Press press{.begin = held_.begin, .end = held_.low_frames > 0 ? held_.low_since : *time_};
  for (std::size_t i = 1; i < change_.size(); ++i)
    if (score(i) > score(press.channel)) press.channel = i;
  press.change = held_.sums[press.channel] / held_.weight;
  if (change_.size() < 2) return press;
  press.second = press.channel == 0 ? 1 : 0;
  for (std::size_t i = 0; i < change_.size(); ++i)
    if (i != press.channel && score(i) > score(press.second)) press.second = i;
  press.second_share = std::abs(held_.sums[press.second] / held_.sums[press.channel]);
  return press;
}

/// Empty where it was too short.
std::optional<Press> PressFinder::end() {
  is_pressed_ = false;
  remembers_ = true;
  least_since_ = held_.peak;
  const Press press = answer();
  if (held_.frames < 2 || seconds_between(press.begin, press.end) < kShortestSeconds) return std::nullopt;
  changes_.push_back(std::abs(press.change));
  typical_ = upper_median(changes_);
  return press;
}

std::optional<Press> PressFinder::hold(std::size_t channel, double seconds) {
  gather(std::abs(static_cast<double>(change_[channel])), seconds);
  const double longest = held_.peak < kFaint * typical_ ? kFaintLongestSeconds : kLongestSeconds;
  if (seconds_between(held_.begin, *time_) > longest) {
    rest_.level = recent_.filtered;
    is_pressed_ = false;
    return std::nullopt;
  }
  const bool is_over = held_.low_frames >= 2 && held_.low_seconds >= kBetweenSeconds;
  return is_over ? end() : std::nullopt;
}

std::optional<Press> PressFinder::add(std::span<const float> counts, Nanos time) {
  const double seconds = std::min(time_ ? seconds_between(*time_, time) : 0.0, kLongestStepSeconds);
  time_ = time;
  filter(counts);
  find_changes();
  const std::size_t channel = strongest();
  if (is_pressed_) return hold(channel, seconds);
  const double change = std::abs(static_cast<double>(change_[channel]));
  const double least = threshold(channel);
  if (change <= kForgotten * least) remembers_ = false;
  if (remembers_) least_since_ = std::min(least_since_, change);
  const double onset = remembers_ ? least_since_ + std::max(least, kRises * held_.peak) : least;
  if (change > onset) {
    begin(change);
    return hold(channel, seconds);
  }
  follow(seconds);
  return std::nullopt;
}

std::optional<Press> PressFinder::finish() {
  return is_pressed_ ? end() : std::nullopt;
}

}  // namespace dermis::learn::arrangement
