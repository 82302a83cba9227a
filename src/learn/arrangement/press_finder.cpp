// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/press_finder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "learn/arrangement/median.hpp"

namespace dermis::learn::arrangement {
namespace {

constexpr double kNoises = 6.0;         // a press is so many deviations from rest,
constexpr double kOfTypical = 0.1;      // and this share of the presses before it
constexpr double kReleased = 0.45;      // of its own peak
constexpr double kRises = 0.15;         // of the last peak, where the array still remembers it
constexpr double kForgotten = 0.5;      // of what would be a press
constexpr double kShortest_s = 0.03;    // and two frames
constexpr double kBetween_s = 0.1;      // and two frames: less is a finger that wobbles
constexpr double kLongest_s = 15.0;     // more is no press, but another rest,
constexpr double kWeakLongest_s = 2.0;  // and sooner
constexpr double kFaint = 0.4;          // below this share of the presses before it
constexpr double kFollows_s = 1.0;      // time constant of the rest,
constexpr double kForgets_s = 0.3;      // and after a press
constexpr double kLongestStep_s = 1.0;  // between two frames, as far as times are believed
constexpr std::size_t kTogether = 5;    // channels of which most may move together
constexpr float kOfLevel = 1e-3F;       // least noise, by the level,
constexpr float kCount = 0.7F;          // and where readings are whole numbers
constexpr float kLeast = 1e-9F;
constexpr float kSigmasOfDeviation = 1.4826F;

bool is_whole(std::span<const std::vector<float>> frames) {
  return std::all_of(frames.begin(), frames.end(), [](const std::vector<float>& frame) {
    return std::all_of(frame.begin(), frame.end(), [](float x) { return !std::isfinite(x) || x == std::round(x); });
  });
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
    if (!readings.empty()) rest.level[i] = median_of(readings);
    for (float& reading : readings) reading = std::abs(reading - rest.level[i]);
    const float deviation = readings.empty() ? 0.0F : kSigmasOfDeviation * median_of(readings);
    rest.noise[i] = std::max({deviation, least, kOfLevel * std::abs(rest.level[i])});
  }
  return rest;
}

PressFinder::PressFinder(Rest rest, double typical)
    : rest_(std::move(rest)),
      last_(rest_.level),
      earlier_(rest_.level),
      filtered_(rest_.level),
      change_(rest_.level.size()),
      sums_(rest_.level.size()),
      typical_(typical) {}

void PressFinder::filter(std::span<const float> counts) {
  assert(counts.size() == last_.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const float now = std::isfinite(counts[i]) ? counts[i] : last_[i];
    filtered_[i] = middle_of(earlier_[i], last_[i], now);
    earlier_[i] = std::exchange(last_[i], now);
  }
}

/// By the rest, less what all channels do together.
void PressFinder::find_changes() {
  for (std::size_t i = 0; i < change_.size(); ++i) change_[i] = filtered_[i] - rest_.level[i];
  if (change_.size() < kTogether) return;
  scratch_ = change_;
  const float together = median_of(scratch_);
  for (float& change : change_) change -= together;
}

double PressFinder::threshold(std::size_t channel) const {
  return std::max(kNoises * static_cast<double>(rest_.noise[channel]), kOfTypical * typical_);
}

std::size_t PressFinder::strongest() const {
  std::size_t strongest = 0;
  double most = -1e300;
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
  const double share = 1.0 - std::exp(-seconds / (remembers_ ? kForgets_s : kFollows_s));
  for (std::size_t i = 0; i < filtered_.size(); ++i)
    rest_.level[i] += static_cast<float>(share) * (filtered_[i] - rest_.level[i]);
}

void PressFinder::begin(double change) {
  is_pressed_ = true;
  remembers_ = false;
  begin_ = time_;
  peak_ = change;
  weight_ = 0.0;
  frames_ = 0;
  low_frames_ = 0;
  low_seconds_ = 0.0;
  std::fill(sums_.begin(), sums_.end(), 0.0);
}

/// What the channels show while the press is strong counts most.
void PressFinder::gather(double change, double seconds) {
  peak_ = std::max(peak_, change);
  if (change < kReleased * peak_) {
    if (low_frames_ == 0) low_since_ = time_;
    ++low_frames_;
    low_seconds_ += low_frames_ > 1 ? seconds : 0.0;
    return;
  }
  frames_ += 1 + low_frames_;
  low_frames_ = 0;
  low_seconds_ = 0.0;
  const double weight = change * change;
  weight_ += weight;
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += weight * static_cast<double>(change_[i]);
}

/// Empty where it was too short.
std::optional<Press> PressFinder::end() {
  is_pressed_ = false;
  remembers_ = true;
  least_since_ = peak_;
  const Nanos until = low_frames_ > 0 ? low_since_ : time_;
  const double lasted = std::abs(std::chrono::duration<double>(until - begin_).count());
  if (frames_ < 2 || lasted < kShortest_s) return std::nullopt;
  const auto score = [&](std::size_t i) {
    return std::abs(sums_[i] / weight_) -
           kNoises / std::sqrt(static_cast<double>(frames_)) * static_cast<double>(rest_.noise[i]);
  };
  Press press{.begin = begin_, .end = until};
  for (std::size_t i = 1; i < sums_.size(); ++i)
    if (score(i) > score(press.channel)) press.channel = i;
  press.change = sums_[press.channel] / weight_;
  press.second = press.channel == 0 && sums_.size() > 1 ? 1 : 0;
  for (std::size_t i = 0; i < sums_.size(); ++i)
    if (i != press.channel && score(i) > score(press.second)) press.second = i;
  if (sums_.size() > 1) press.second_share = std::abs(sums_[press.second] / sums_[press.channel]);
  peaks_.push_back(std::abs(press.change));
  typical_ = median_of(peaks_);
  return press;
}

std::optional<Press> PressFinder::hold(std::size_t channel, double seconds) {
  gather(std::abs(static_cast<double>(change_[channel])), seconds);
  const double longest = peak_ < kFaint * typical_ ? kWeakLongest_s : kLongest_s;
  if (std::abs(std::chrono::duration<double>(time_ - begin_).count()) > longest) {
    rest_.level = filtered_;
    is_pressed_ = false;
    return std::nullopt;
  }
  const bool is_low_enough = low_frames_ >= 2 && low_seconds_ >= kBetween_s;
  return is_low_enough ? end() : std::nullopt;
}

std::optional<Press> PressFinder::add(std::span<const float> counts, Nanos time) {
  const double step = has_time_ ? std::abs(std::chrono::duration<double>(time - time_).count()) : 0.0;
  const double seconds = std::min(step, kLongestStep_s);
  time_ = time;
  has_time_ = true;
  filter(counts);
  find_changes();
  const std::size_t channel = strongest();
  if (is_pressed_) return hold(channel, seconds);
  const double change = std::abs(static_cast<double>(change_[channel]));
  const double least = threshold(channel);
  if (change <= kForgotten * least) remembers_ = false;
  if (remembers_) least_since_ = std::min(least_since_, change);
  const double onset = remembers_ ? least_since_ + std::max(least, kRises * peak_) : least;
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
