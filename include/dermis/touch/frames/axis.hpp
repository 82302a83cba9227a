// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis {

/// Which lines of an array are meant.
enum class Axis : std::uint8_t { row, column };

inline constexpr std::array<Axis, 2> kAxes{Axis::row, Axis::column};

/// The axis of the lines that cross those of `axis`.
[[nodiscard]] constexpr Axis crossing(Axis axis) noexcept {
  return axis == Axis::row ? Axis::column : Axis::row;
}

/// "row" or "column".
[[nodiscard]] constexpr const char* to_string(Axis axis) noexcept {
  return axis == Axis::row ? "row" : "column";
}

/// One value for the rows and one for the columns.
template <typename T>
struct PerAxis {
  T row{};
  T column{};

  [[nodiscard]] constexpr T& operator[](Axis axis) noexcept { return axis == Axis::row ? row : column; }
  [[nodiscard]] constexpr const T& operator[](Axis axis) const noexcept { return axis == Axis::row ? row : column; }

  bool operator==(const PerAxis&) const = default;
};

/// Number of rows, or of columns.
[[nodiscard]] inline std::size_t line_count(const ArrayDescription& array, Axis axis) noexcept {
  return axis == Axis::row ? array.rows : array.cols;
}

/// Number of taxels on each row, or column.
[[nodiscard]] inline std::size_t line_length(const ArrayDescription& array, Axis axis) noexcept {
  return line_count(array, crossing(axis));
}

/// Row-major index of the taxel at `place`, counted from 0, on a row or column.
[[nodiscard]] inline std::size_t taxel_on_line(const ArrayDescription& array, Axis axis, std::size_t line,
                                               std::size_t place) noexcept {
  return axis == Axis::row ? array.index(line, place) : array.index(place, line);
}

/// The row or column on which a taxel is.
[[nodiscard]] inline std::size_t line_of(const ArrayDescription& array, Axis axis, std::size_t taxel) noexcept {
  return axis == Axis::row ? taxel / array.cols : taxel % array.cols;
}

/// The lines with a driver: rows, or columns for `flexitac`.
[[nodiscard]] inline Axis driven_axis(const ArrayDescription& array) noexcept {
  return array.readout.circuit == Circuit::flexitac ? Axis::column : Axis::row;
}

}  // namespace dermis
