// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::suits {

/// Counts latencies in classes of 6 % over the last seconds. Allocates nothing. Not thread-safe.
class LatencyMeter {
 public:
  /// `now` does not go back by more than a second.
  void add(Nanos now, Nanos latency) noexcept;

  /// The latency that `share` of the frames did not exceed, to 3 %; 0 where none came in the last seconds.
  [[nodiscard]] Nanos quantile(Nanos now, double share) const noexcept;

 private:
  static constexpr std::size_t kClassesPerOctave = 16;
  static constexpr std::size_t kOctaves = 32;  // 16 ns ... 68 s
  static constexpr std::size_t kClasses = kClassesPerOctave * kOctaves;
  static constexpr std::int64_t kSeconds = 5;

  struct Second {
    std::int64_t second = -1;
    std::array<std::uint32_t, kClasses> counts{};
  };

  [[nodiscard]] static std::size_t class_of(Nanos latency) noexcept;
  [[nodiscard]] static Nanos middle_of(std::size_t index) noexcept;

  std::array<Second, kSeconds> seconds_{};
};

}  // namespace dermis::live::suits
