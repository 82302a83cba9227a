// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::arrangement::testing {

/// A board whose channels are pressed one after another.
struct Board {
  std::size_t channels = 17;
  double rate_hz = 50.0;
  double level = 300.0;
  double press = 500.0;  ///< Below 0: readings fall.
  double noise = 2.0;
  double crosstalk = 0.15;  ///< On all others,
  double neighbour = 0.4;   ///< and on those of the next numbers.
  double drift_per_s = 0.0;
  double memory = 0.15;   ///< Share of a press that fades slowly after it.
  double together = 0.0;  ///< A hum of all channels.
  double held_s = 0.6;
  double between_s = 0.5;
  double before_s = 1.0;

  /// A channel below 0: a time in which nothing is pressed.
  [[nodiscard]] std::vector<RawFrame> frames(const std::vector<int>& pressed, std::uint64_t seed = 1) const {
    Random random(seed);
    std::vector<RawFrame> frames;
    std::vector<double> kept(channels, 0.0);
    const double period = held_s + between_s;
    const auto count = static_cast<std::size_t>((before_s + period * static_cast<double>(pressed.size())) * rate_hz);
    for (std::size_t k = 0; k < count; ++k) {
      const double time = static_cast<double>(k) / rate_hz;
      const double since = time - before_s;
      const auto place = static_cast<std::ptrdiff_t>(std::floor(since / period));
      const double within = since - static_cast<double>(place) * period;
      const bool is_held = place >= 0 && place < static_cast<std::ptrdiff_t>(pressed.size()) && within < held_s;
      const double force = is_held ? std::min({1.0, within / 0.1, (held_s - within) / 0.1}) : 0.0;
      const int channel = is_held ? pressed[static_cast<std::size_t>(place)] : -1;
      RawFrame frame;
      frame.time = std::chrono::nanoseconds(std::llround(1e9 * time));
      for (std::size_t i = 0; i < channels; ++i) {
        const int distance = channel < 0 ? 99 : std::abs(static_cast<int>(i) - channel);
        const double share = channel < 0 ? 0.0 : distance == 0 ? 1.0 : distance == 1 ? neighbour : crosstalk;
        kept[i] = std::max(kept[i] * std::exp(-1.0 / (rate_hz * 1.5)), memory * force * share);
        const double change = press * std::max(force * share, kept[i]);
        const double hum = together * std::sin(40.0 * time);
        const double read = level + change + drift_per_s * time + hum + noise * random.normal();
        frame.counts.push_back(static_cast<float>(std::round(std::clamp(read, 0.0, 4095.0))));
      }
      frames.push_back(frame);
    }
    return frames;
  }
};

/// 0 to count - 1, shuffled.
inline std::vector<int> shuffled(std::size_t count, std::uint64_t seed = 7) {
  std::vector<int> order(count);
  for (std::size_t k = 0; k < count; ++k) order[k] = static_cast<int>(k);
  Random random(seed);
  for (std::size_t k = count; k > 1; --k) std::swap(order[k - 1], order[random.below(k)]);
  return order;
}

}  // namespace dermis::learn::arrangement::testing
