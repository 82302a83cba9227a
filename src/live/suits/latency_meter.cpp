// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/latency_meter.hpp"

#include <algorithm>
#include <bit>

namespace dermis::live::suits {
namespace {

std::int64_t second_of(Nanos now) noexcept {
  return std::chrono::duration_cast<std::chrono::seconds>(now).count();
}

}  // namespace

std::size_t LatencyMeter::class_of(Nanos latency) noexcept {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(latency.count(), kClassesPerOctave));
  const auto octave = static_cast<unsigned>(std::bit_width(ns) - std::bit_width(kClassesPerOctave));
  const std::size_t within = static_cast<std::size_t>(ns >> octave) - kClassesPerOctave;
  return std::min(octave * kClassesPerOctave + within, kClasses - 1);
}

Nanos LatencyMeter::middle_of(std::size_t index) noexcept {
  const std::size_t octave = index / kClassesPerOctave;
  const std::size_t within = index % kClassesPerOctave + kClassesPerOctave;
  return Nanos(static_cast<std::int64_t>(((2 * within + 1) << octave) / 2));
}

void LatencyMeter::add(Nanos now, Nanos latency) noexcept {
  const std::int64_t second = second_of(now);
  Second& slot = seconds_[static_cast<std::size_t>(second % kSeconds)];
  if (slot.second != second) slot = Second{.second = second};
  ++slot.counts[class_of(latency)];
}

Nanos LatencyMeter::quantile(Nanos now, double share) const noexcept {
  std::array<std::uint64_t, kClasses> counts{};
  std::uint64_t total = 0;
  for (const Second& slot : seconds_) {
    if (slot.second < 0 || slot.second <= second_of(now) - kSeconds) continue;
    for (std::size_t index = 0; index < kClasses; ++index) counts[index] += slot.counts[index];
  }
  for (const std::uint64_t count : counts) total += count;
  if (total == 0) return Nanos{};
  const double wanted = share * static_cast<double>(total);
  std::uint64_t seen = 0;
  std::size_t index = 0;
  while (index + 1 < kClasses && static_cast<double>(seen += counts[index]) < wanted) ++index;
  return middle_of(index);
}

}  // namespace dermis::live::suits
