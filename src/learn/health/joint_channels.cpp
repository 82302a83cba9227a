// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/joint_channels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestFrames = 60;
constexpr std::size_t kFewestChannels = 8;
constexpr std::size_t kMultiplexer = 16;  // channels
constexpr double kLeft = 1.6;             // times its noise, and
constexpr double kLeftOfMotion = 0.15;    // of the common motion: a channel has nothing of its own
constexpr double kLeastNoise = 0.5;       // counts
constexpr double kRamp = 0.1;             // of the highest: from the first channel to the last,
constexpr double kRampNoise = 10.0;       // and times the noise
constexpr double kInOrder = 3.0;          // errors of a mean by which neighbours may exchange
constexpr double kMoves = 0.2;            // of the mean of all
constexpr double kMovesNoise = 10.0;      // and times the noise
constexpr double kMostRatio = 5.0;        // of the highest to the lowest mean: more is a load on all
constexpr double kSpread = 0.12;          // of the gains: taxels differ more
constexpr double kTwoLevels = 0.19;       // of the squared range: variance of what is put on or taken off once
constexpr double kMostCelsius = 3.0;
constexpr Nanos kFast = std::chrono::seconds(2);
constexpr double kFastest = 0.1;     // of the mean of all: rubber warms up more slowly
constexpr double kActive = 0.25;     // of the largest variance
constexpr double kSmooth = 0.6;      // correlation from frame to frame: touches last several frames,
constexpr double kTooSmooth = 0.98;  // and come and go
constexpr double kReturns = 0.8;     // of twice its range: the path of a reading that came and went
constexpr double kFlank = 0.25;      // of its range: the largest step of a touch that lasts many frames

}  // namespace

JointChannels::JointChannels(std::size_t taxels) : channels_(taxels) {}

void JointChannels::add(std::span<const float> counts, const RawFrame& raw) {
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
  follow_all(all, raw);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    Channel& channel = channels_[k];
    const auto reading = static_cast<double>(counts[k]);
    if (frames_ == 0) channel.first = channel.last = reading;
    const double change = reading - channel.first;
    const double step = reading - channel.last;
    channel.last = reading;
    channel.sum += change;
    channel.squares += change * change;
    channel.with_all += change * (all - first_all_);
    channel.steps += step * step;
    channel.path += std::abs(step);
    channel.longest = std::max(channel.longest, std::abs(step));
    channel.least = std::min(channel.least, change);
    channel.most = std::max(channel.most, change);
  }
  ++frames_;
}

void JointChannels::follow_all(double all, const RawFrame& raw) {
  if (frames_ == 0) {
    first_all_ = least_all_ = most_all_ = marked_all_ = all;
    marked_ = raw.time;
  }
  all_sum_ += all - first_all_;
  all_squares_ += (all - first_all_) * (all - first_all_);
  least_all_ = std::min(least_all_, all);
  most_all_ = std::max(most_all_, all);
  const Nanos since = raw.time - marked_;
  if (since <= kFast) fastest_ = std::max(fastest_, std::abs(all - marked_all_));
  if (since >= kFast || since < Nanos{}) {
    marked_all_ = all;
    marked_ = raw.time;
  }
  if (!raw.temperature_celsius) return;
  coldest_ = std::min(coldest_.value_or(*raw.temperature_celsius), *raw.temperature_celsius);
  hottest_ = std::max(hottest_.value_or(*raw.temperature_celsius), *raw.temperature_celsius);
}

double JointChannels::mean(const Channel& channel) const {
  return channel.first + channel.sum / static_cast<double>(frames_);
}

/// By differences from frame to frame.
double JointChannels::noise(const Channel& channel) const {
  return std::max(std::sqrt(0.5 * channel.steps / static_cast<double>(frames_ - 1)), kLeastNoise);
}

double JointChannels::gain(const Channel& channel) const {
  const auto frames = static_cast<double>(frames_);
  const double variance = all_squares_ - all_sum_ * all_sum_ / frames;
  return variance > 0.0 ? (channel.with_all - channel.sum * all_sum_ / frames) / variance : 0.0;
}

/// Standard deviation of what the motion of all does not explain.
double JointChannels::left(const Channel& channel) const {
  const auto frames = static_cast<double>(frames_);
  const double own = channel.squares - channel.sum * channel.sum / frames;
  const double common = channel.with_all - channel.sum * all_sum_ / frames;
  return std::sqrt(std::max(own - gain(channel) * common, 0.0) / frames);
}

bool JointChannels::answers_alone(const Channel& channel) const {
  const auto frames = static_cast<double>(frames_);
  const double motion = std::sqrt(std::max(all_squares_ - all_sum_ * all_sum_ / frames, 0.0) / frames);
  return left(channel) > std::max(kLeft * noise(channel), kLeftOfMotion * std::abs(gain(channel)) * motion);
}

/// -1 or 1 where the means of these channels fall or rise in their order, clearly; 0 elsewhere.
int JointChannels::direction(std::size_t from, std::size_t to) const {
  const double span = mean(channels_[to - 1]) - mean(channels_[from]);
  const int sign = span < 0.0 ? -1 : 1;
  double highest = 0.0;
  for (std::size_t k = from; k < to; ++k) {
    highest = std::max(highest, mean(channels_[k]));
    if (k == from) continue;
    const double within = kInOrder * noise(channels_[k]) / std::sqrt(static_cast<double>(frames_));
    if (sign * (mean(channels_[k]) - mean(channels_[k - 1])) < -within) return 0;
  }
  const bool is_clear = std::abs(span) > std::max(kRamp * highest, kRampNoise * noise(channels_[from]));
  return is_clear ? sign : 0;
}

/// All channels in one order, or those of each multiplexer.
bool JointChannels::is_ramp() const {
  const std::size_t count = channels_.size();
  for (const std::size_t length : {count, kMultiplexer, kFewestChannels}) {
    if (length < kFewestChannels || count % length != 0) continue;
    const int first = direction(0, length);
    bool all_alike = first != 0;
    for (std::size_t from = length; from < count && all_alike; from += length) {
      all_alike = direction(from, from + length) == first;
    }
    if (all_alike) return true;
  }
  return false;
}

/// By about the same counts, and sooner than rubber warms up.
bool JointChannels::moves_together() const {
  const auto count = static_cast<double>(channels_.size());
  const double mean_of_all = first_all_ + all_sum_ / static_cast<double>(frames_);
  const double range = most_all_ - least_all_;
  if (range < std::max(kMoves * mean_of_all, kMovesNoise * noise(channels_.front()))) return false;
  if (most_all_ > kMostRatio * least_all_ || fastest_ < kFastest * mean_of_all) return false;
  const double variance =
      all_squares_ / static_cast<double>(frames_) - std::pow(all_sum_ / static_cast<double>(frames_), 2);
  if (is_warmed() || variance > kTwoLevels * range * range) return false;
  double squares = 0.0;
  for (const Channel& channel : channels_) squares += (gain(channel) - 1.0) * (gain(channel) - 1.0);
  return std::sqrt(squares / count) < kSpread;
}

double JointChannels::variance(const Channel& channel) const {
  const auto frames = static_cast<double>(frames_);
  return (channel.squares - channel.sum * channel.sum / frames) / frames;
}

bool JointChannels::is_warmed() const {
  return coldest_ && *hottest_ - *coldest_ > kMostCelsius;
}

bool JointChannels::has_smooth_touches() const {
  if (frames_ < kFewestFrames || is_warmed()) return false;
  double most = 0.0;
  for (const Channel& channel : channels_) most = std::max(most, variance(channel));
  double sum = 0.0;
  double count = 0.0;
  for (const Channel& channel : channels_) {
    if (most <= 0.0 || variance(channel) < kActive * most) continue;
    sum += 1.0 - 0.5 * channel.steps / static_cast<double>(frames_) / variance(channel);
    count += 1.0;
  }
  return sum > kSmooth * count && (sum < kTooSmooth * count || has_slow_touches());
}

/// Most of those that answer by themselves came and went, without the steps of what is put on for minutes.
bool JointChannels::has_slow_touches() const {
  std::size_t alone = 0;
  std::size_t touched = 0;
  for (const Channel& channel : channels_) {
    if (!answers_alone(channel)) continue;
    const double range = channel.most - channel.least;
    ++alone;
    touched += channel.path > 2.0 * kReturns * range && channel.longest < kFlank * range ? 1 : 0;
  }
  return 2 * touched > alone;
}

std::optional<std::string> JointChannels::finding() const {
  if (frames_ < kFewestFrames || channels_.size() < kFewestChannels) return std::nullopt;
  if (std::any_of(channels_.begin(), channels_.end(), [&](const Channel& channel) { return answers_alone(channel); })) {
    return std::nullopt;
  }
  constexpr const char* kMend =
      "and none answers by itself: nothing drives the input of the ADC; check the multiplexer's supply, ground and "
      "enable pin, and its wire to the ADC";
  if (is_ramp()) {
    return fmt::format("the {} channels {} together, one after another from {:.0f} to {:.0f} counts, {}",
                       channels_.size(), mean(channels_.back()) < mean(channels_.front()) ? "fall" : "rise",
                       mean(channels_.front()), mean(channels_.back()), kMend);
  }
  if (!moves_together()) return std::nullopt;
  return fmt::format("the {} channels rise and fall together, between {:.0f} and {:.0f} counts in the mean, {}",
                     channels_.size(), least_all_, most_all_, kMend);
}

}  // namespace dermis::learn::health
