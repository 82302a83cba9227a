// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bytes/layouts/unwrapped.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::layouts {

/// The content of a line or a packet: a frame, a row, a taxel, or any run of taxels.
struct Piece {
  std::size_t array = 0;  ///< Place of the array whose readings these are.
  std::optional<std::uint64_t> row{};
  std::optional<std::uint64_t> col{};
  std::optional<std::uint64_t> first{};
  std::optional<std::uint64_t> frame{};
  std::optional<std::uint64_t> flags{};
  std::optional<std::uint64_t> time_ns{};
  double time_unit = 0.0;         ///< Seconds, of the field that was read last.
  bool is_time_of_heads = false;  ///< None of this line was read yet.
  std::optional<double> temperature_celsius{};
  std::vector<float> sensor_celsius{};  ///< Where there are several temperatures; NaN: no reading.
  std::optional<double> supply_v{};

  /// One after the other; not finite or beyond float: no reading.
  void add_temperature(double celsius);
  void forget_temperatures() noexcept;

  /// Times in different units add up where they stand in a line, or the smaller one in a line behind: secs and nsecs.
  void set_time(std::uint64_t nanos, double unit) noexcept {
    const bool adds = unit < time_unit || (unit > time_unit && !is_time_of_heads);
    time_ns = nanos + (adds ? time_ns.value_or(0) : 0);
    time_unit = unit;
    is_time_of_heads = false;
  }
};

/// Moduli of what a device counts; 0: it does not wrap.
struct Moduli {
  std::uint64_t frame = 0;
  std::uint64_t time_ns = 0;
};

/// Readings from numbers, and what a frame says beside them.
class FrameFields {
 public:
  FrameFields(const Layout& layout, const Moduli& moduli);

  /// Makes readings of numbers. A number that means no reading becomes NaN.
  void scale(std::span<float> numbers) const noexcept;

  /// Writes number, time, temperature and supply beside the readings of a frame. `piece` is its first. False where the
  /// device says that the frame is corrupt.
  [[nodiscard]] bool write(const Piece& piece, RawFrame& frame);

 private:
  void count(std::uint64_t number, Acquisition& acquisition);

  const Layout& layout_;
  bool has_plain_readings_;
  Unwrapped frame_number_;
  Unwrapped time_;
  std::optional<std::int64_t> last_number_;
};

}  // namespace dermis::bytes::layouts
