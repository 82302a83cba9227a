// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/frame_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "dermis/touch/frames/mean_celsius.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::int64_t kMostLost = 1000;  // more missing frames are a restart of the device
constexpr std::int64_t kMostLateFrames = 63;
constexpr std::int64_t kMostLateNanos = 1'000'000'000;
constexpr float kAbsent = std::numeric_limits<float>::quiet_NaN();

bool is_in(const std::vector<NumberRange>& ranges, double number) noexcept {
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const NumberRange& range) { return number >= range.least && number <= range.most; });
}

bool holds(const std::vector<std::uint64_t>& values, const std::optional<std::uint64_t>& flags) {
  return flags && std::find(values.begin(), values.end(), *flags) != values.end();
}

}  // namespace

void Piece::add_temperature(double celsius) {
  constexpr double kMost = std::numeric_limits<float>::max();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!(std::abs(celsius) <= kMost)) celsius = kNone;
  if (temperature_celsius && sensor_celsius.empty()) {
    sensor_celsius.push_back(static_cast<float>(*temperature_celsius));
  }
  if (temperature_celsius) sensor_celsius.push_back(static_cast<float>(celsius));
  temperature_celsius =
      sensor_celsius.empty() ? celsius : mean_celsius(std::span<const float>(sensor_celsius)).value_or(kNone);
}

void Piece::forget_temperatures() noexcept {
  temperature_celsius.reset();
  sensor_celsius.clear();
}

FrameFields::FrameFields(const Layout& layout, const Moduli& moduli)
    : layout_(layout),
      has_plain_readings_(layout.scale == 1.0 && layout.offset == 0.0 && layout.absent.empty()),
      frame_number_(moduli.frame),
      time_(moduli.time_ns) {}

void FrameFields::scale(std::span<float> numbers) const noexcept {
  if (has_plain_readings_) return;
  for (float& value : numbers) {
    const auto number = static_cast<double>(value);
    value = is_in(layout_.absent, number) ? kAbsent : static_cast<float>(layout_.scale * number + layout_.offset);
  }
}

bool FrameFields::write(const Piece& piece, RawFrame& frame) {
  if (holds(layout_.flags.corrupt, piece.flags)) return false;
  if (holds(layout_.flags.absent, piece.flags)) std::fill(frame.counts.begin(), frame.counts.end(), kAbsent);
  frame.temperature_celsius = piece.temperature_celsius;
  if (frame.temperature_celsius && std::isnan(*frame.temperature_celsius)) frame.temperature_celsius.reset();
  frame.sensor_celsius = piece.sensor_celsius;
  frame.supply_v = piece.supply_v;
  frame.acquisition = {};
  if (piece.frame) count(*piece.frame, frame.acquisition);
  if (piece.time_ns) frame.acquisition.device_time = Nanos(time_.count(*piece.time_ns, kMostLateNanos));
  return true;
}

void FrameFields::count(std::uint64_t number, Acquisition& acquisition) {
  const std::int64_t total = frame_number_.count(number, kMostLateFrames);
  const std::int64_t step = last_number_ ? total - *last_number_ : 1;
  if (step > 1 && step <= kMostLost + 1) acquisition.lost_before = static_cast<std::uint32_t>(step - 1);
  acquisition.sequence = static_cast<std::uint64_t>(total);
  last_number_ = total;
}

}  // namespace dermis::bytes::layouts
