// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Frames in an array of numbers of any system (.npy, .npz, .mat, HDF5): which axis counts them, and what of it is
/// taken. Messages do not name the file.
namespace dermis::bytes::files {

/// An array and what is taken of it: "tactile[..., 2]".
struct ArrayChoice {
  std::string name{};  ///< "tactile"
  std::string axes{};  ///< "..., 2", as numpy has it; empty: all.
};

[[nodiscard]] ArrayChoice array_choice(const std::string& text);

/// An array of numbers in memory.
struct NumberArray {
  std::vector<std::size_t> sizes{};
  std::vector<std::size_t> steps{};  ///< Values from one index of an axis to the next.
  std::size_t begin = 0;             ///< The first value.

  /// The last axis runs fastest, as in C; or the first one, as in Fortran and MATLAB.
  [[nodiscard]] static NumberArray last_fastest(std::vector<std::size_t> sizes);
  [[nodiscard]] static NumberArray first_fastest(std::vector<std::size_t> sizes);
  [[nodiscard]] std::size_t value_count() const noexcept;  ///< The largest number where it has more.
  [[nodiscard]] std::string sizes_text() const;            ///< "12 x 30 x 14"
};

/// Most values of an array that is read as a whole.
inline constexpr std::size_t kMostArrayValues = std::size_t{1} << 26U;

/// Where the readings of a frame are in the values.
struct FrameAxes {
  FrameShape shape{};
  std::size_t frames = 0;
  std::size_t begin = 0;
  std::size_t frame_step = 0;
  std::size_t row_step = 0;
  std::size_t col_step = 0;

  /// Frame by frame, row by row, and nothing else.
  [[nodiscard]] bool is_in_order() const noexcept;
};

/// The axes of three, of which `time` counts the frames; rows come before columns.
[[nodiscard]] FrameAxes axes_of(const NumberArray& array, std::size_t time);
/// Two axes are frames and taxels, row by row, or one frame. Empty where the array is none of this shape.
[[nodiscard]] std::optional<FrameAxes> axes_of_table(const NumberArray& array, FrameShape shape);
/// The axis along which readings change least, where that is clear and there are enough of them.
[[nodiscard]] std::optional<std::size_t> smoothest_axis(const NumberArray& array, const std::vector<std::size_t>& axes,
                                                        std::span<const float> values);

/// Knowledge of an array beside its sizes.
struct ArrayHints {
  std::string source;                 ///< For messages: "file.npz#tactile", to which [axes] are appended.
  std::string axes{};                 ///< As ArrayChoice::axes: indices, ":", "...", and "frames", "rows", "cols".
  std::optional<FrameShape> shape{};  ///< The frames must have it.
  std::size_t times = 0;              ///< How many times stand beside it; 0: none.
};

/// frame_axes() must see the values: the last axis may count the frames as well as the first.
[[nodiscard]] bool needs_values(const NumberArray& array, const ArrayHints& hints);
/// Frames stand first, unless the hints say otherwise or nothing else is possible. Axes of size 1 are passed over.
/// Fails, with both ways to say it, where sizes and `values` leave a doubt, and on four axes of which none is chosen.
[[nodiscard]] Result<FrameAxes> frame_axes(const NumberArray& array, const ArrayHints& hints,
                                           std::span<const float> values);

/// When frames were taken.
struct ArrayTimes {
  std::vector<double> seconds{};  ///< Empty: the rate gives them.
  std::optional<double> rate_hz{};
};

/// Names of the times beside an array, the first that is there counts. Where the name says no unit, it is 0.
struct TimeName {
  const char* name;
  double unit_s;
};
inline constexpr std::array<TimeName, 6> kTimeNames{
    {{"time_ns", 1e-9}, {"time_s", 1.0}, {"timestamps", 0.0}, {"timestamp", 0.0}, {"time", 0.0}, {"t", 0.0}}};

/// Seconds of times in a unit, 0: of those since 1970 their size tells it, others are seconds. Fails where these would
/// go on by a second and more.
[[nodiscard]] Result<std::vector<double>> seconds_of(std::vector<double> numbers, double unit_s);

/// `place` names the array in messages of the frames.
[[nodiscard]] std::unique_ptr<FrameSource> frames_of_array(std::string place, FrameAxes axes, std::vector<float> values,
                                                           ArrayTimes times);

}  // namespace dermis::bytes::files
