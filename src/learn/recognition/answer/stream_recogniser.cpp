// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/stream_recogniser.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "learn/recognition/valid_reading.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kPoseSeconds = 0.5;
constexpr std::size_t kGestureFrames = 1024;  // of a longer one the end counts
constexpr std::size_t kMostPoseFrames = 1024;
constexpr std::size_t kMostKept = std::size_t{1} << 26U;  // readings: 256 MiB

std::size_t window_of(const Classes& classes, const Layout& source) {
  if (classes.moving) return kGestureFrames;
  const double frames = std::round(kPoseSeconds * source.rate_hz);
  return static_cast<std::size_t>(std::clamp(frames, 1.0, static_cast<double>(kMostPoseFrames)));
}

/// Where the touch of the last of these frames began: what was before it fell below half of its force. One much weaker
/// than the largest force is noise after a touch.
std::size_t onset_among(std::span<const double> forces) {
  constexpr double kReleased = 0.5;
  constexpr double kLeastShare = 0.1;
  const double least = kLeastShare * *std::max_element(forces.begin(), forces.end());
  double peak = 0.0;
  for (std::size_t frame = forces.size(); frame > 0; --frame) {
    peak = std::max(peak, forces[frame - 1]);
    if (peak >= least && forces[frame - 1] < kReleased * peak) return frame;
  }
  return 0;
}

}  // namespace

double force_of(const Layout& layout, std::span<const float> readings) {
  double force = 0.0;
  for (const SensedArray& array : layout.arrays) {
    for (const float reading : readings.subspan(array.first_column, array.taxel_count()))
      force += valid_reading(reading);
  }
  return force;
}

Result<StreamRecogniser> StreamRecogniser::create(Classes classes, const Layout& source) {
  if (classes.moving && !classes.touches) {
    return bad_input("where touches begin and end was not learned: the labels leave no frame without a touch");
  }
  if (Status checked = source.validate(); !checked) return checked.error();
  const std::size_t window = window_of(classes, source);
  if (source.readings > kMostKept / (2 * window)) {
    return bad_input("frames of " + std::to_string(source.readings) + " readings are too large to look at " +
                     std::to_string(window) + " of them together; at most " + std::to_string(kMostKept / (2 * window)) +
                     " readings are possible");
  }
  Result<Recogniser> recogniser = Recogniser::create(std::move(classes), source, window);
  if (!recogniser) return recogniser.error();
  return StreamRecogniser(*std::move(recogniser), source, window);
}

StreamRecogniser::StreamRecogniser(Recogniser recogniser, const Layout& source, std::size_t window)
    : recogniser_(std::move(recogniser)),
      source_(source),
      window_(window),
      readings_(2 * window * source.readings),
      extras_(2 * window * source.extras),
      forces_(2 * window) {
  if (recogniser_.classes().moving) finder_.emplace(*recogniser_.classes().touches);
}

void StreamRecogniser::keep(std::span<const float> readings, std::span<const float> extras) {
  assert(readings.size() == source_.readings && extras.size() == source_.extras);
  const auto move_up = [&](auto& buffer, std::size_t columns) {
    const auto end = buffer.begin() + static_cast<std::ptrdiff_t>(kept_ * columns);
    std::copy(end - static_cast<std::ptrdiff_t>(window_ * columns), end, buffer.begin());
  };
  if (kept_ == 2 * window_) {
    move_up(readings_, source_.readings);
    move_up(extras_, source_.extras);
    move_up(forces_, 1);
    kept_ = window_;
  }
  std::copy(readings.begin(), readings.end(),
            readings_.begin() + static_cast<std::ptrdiff_t>(kept_ * source_.readings));
  std::copy(extras.begin(), extras.end(), extras_.begin() + static_cast<std::ptrdiff_t>(kept_ * source_.extras));
  forces_[kept_] = force_of(source_, readings);
  ++kept_;
  ++frame_;
}

/// The last half second, or what of it is the touch that is there now.
Touch StreamRecogniser::held_touch() const {
  const std::size_t count = std::min(kept_, window_);
  const std::size_t onset = onset_among(std::span(forces_).subspan(kept_ - count, count));
  return {frame_ - count + onset, frame_ - 1};
}

Recognition StreamRecogniser::recognise(const Touch& touch) {
  const std::size_t oldest = frame_ - kept_;
  const std::size_t first = std::max(touch.first, oldest);
  const std::size_t count = touch.last - first + 1;
  const Segment segment{
      std::span<const float>(readings_).subspan((first - oldest) * source_.readings, count * source_.readings),
      std::span<const float>(extras_).subspan((first - oldest) * source_.extras, count * source_.extras)};
  return {touch, recogniser_.recognise(segment)};
}

std::optional<Recognition> StreamRecogniser::next(std::span<const float> readings, std::span<const float> extras) {
  keep(readings, extras);
  if (!finder_) return recognise(held_touch());
  const std::optional<Touch> touch = finder_->next(forces_[kept_ - 1]);
  if (!touch) return std::nullopt;
  return recognise(*touch);
}

std::optional<Recognition> StreamRecogniser::finish() {
  const std::optional<Touch> touch = finder_ ? finder_->finish() : std::nullopt;
  if (!touch) return std::nullopt;
  return recognise(*touch);
}

}  // namespace dermis::learn::recognition
