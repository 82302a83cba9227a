// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// The unit of recognition: a piece of the stream of one or several arrays.
namespace dermis::learn::recognition {

inline constexpr std::size_t kMostLines = 1024;  ///< Rows, and columns.

/// Values of another array, or further readings, that are older than this are stale.
inline constexpr Nanos kLongestSilence = std::chrono::milliseconds(500);

/// One array among those whose readings stand side by side in a frame.
struct SensedArray {
  std::string name{};            ///< UTF-8 without control characters.
  std::size_t rows = 1;          ///< 1 ... 1024
  std::size_t cols = 1;          ///< 1 ... 1024
  std::size_t first_column = 0;  ///< Place of r0c0 in the frame; the other taxels follow, row-major.
  double row_pitch_mm = 0.0;     ///< Distance of two rows, 0.001 ... 10000; 0 where it is not known.
  double col_pitch_mm = 0.0;     ///< Distance of two columns; 0 where it is not known.

  [[nodiscard]] std::size_t taxel_count() const noexcept { return rows * cols; }
  [[nodiscard]] bool has_pitch() const noexcept { return row_pitch_mm > 0.0 && col_pitch_mm > 0.0; }
  bool operator==(const SensedArray&) const = default;
};

/// An array whose taxels are the readings of a frame. `name`: that of the array, or the one it has in a suit.
[[nodiscard]] SensedArray sensed_array(const ArrayDescription& array, const std::string& name);

[[nodiscard]] std::vector<std::string> names_of(const std::vector<SensedArray>& arrays);

/// Whether so many frames a second can be, or 0: not known.
[[nodiscard]] bool is_rate(double rate_hz) noexcept;

inline constexpr double kLeastNewtons = 0.01;  ///< The least force that means anything [N].

/// How a frame is laid out, and what its numbers mean.
struct Layout {
  std::vector<SensedArray> arrays;       ///< 1 ... 64, that do not overlap.
  std::size_t readings = 0;              ///< Of a frame, of all arrays.
  std::size_t extras = 0;                ///< Further readings beside a frame, such as joint angles.
  double rate_hz = 0.0;                  ///< Frames a second, 0.001 ... 1e6; 0 where it is not known.
  Quantity quantity = Quantity::counts;  ///< Quantity of a reading; counts also where it is not known.

  [[nodiscard]] bool has_forces() const noexcept { return quantity == Quantity::force; }
  /// The least reading that means anything: kLeastNewtons, or 1 of any other quantity. Logarithms begin here.
  [[nodiscard]] double least_reading() const noexcept { return has_forces() ? kLeastNewtons : 1.0; }

  /// The first error in it, as "arrays: ...".
  [[nodiscard]] Status validate() const;
  bool operator==(const Layout&) const = default;
};

/// Consecutive frames, from onset to release or while a pose is held; one frame where a pose is a single picture. The
/// readings are tared: at least 0, in proportion to the load. Whoever owns them outlives it.
struct Segment {
  std::span<const float> frames;  ///< [frames, readings]
  std::span<const float> extras;  ///< [frames, extras]; empty where there are none.
};

}  // namespace dermis::learn::recognition
