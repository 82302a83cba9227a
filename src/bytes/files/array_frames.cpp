// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/array_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bytes/files/axis_words.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kFewestFrames = 10;  // whose changes tell
constexpr double kClearly = 0.5;           // of the change along the next axis
constexpr std::size_t kLopsided = 2;       // times as long as any other axis: frames, as a rule
constexpr std::size_t kLopsidedMiddle = 4;

bool is_possible(FrameShape shape) {
  return shape.rows >= 1 && shape.rows <= kMaxLines && shape.cols >= 1 && shape.cols <= kMaxLines;
}

/// Mean square of the change from one value to the next along an axis of three.
double change_along(const NumberArray& array, std::size_t axis, std::span<const float> values) {
  const FrameAxes axes = axes_of(array, axis);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k + 1 < axes.frames; ++k) {
    for (std::size_t taxel = 0; taxel < axes.shape.taxel_count(); ++taxel) {
      const std::size_t at = axes.begin + k * axes.frame_step + taxel / axes.shape.cols * axes.row_step +
                             taxel % axes.shape.cols * axes.col_step;
      const auto change = static_cast<double>(values[at + axes.frame_step] - values[at]);
      if (!std::isfinite(change)) continue;
      sum += change * change;
      ++count;
    }
  }
  return count == 0 ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(count);
}

/// The axes that may count the frames: the first or last, or the middle one where the shape is told.
std::vector<std::size_t> possible_axes(const NumberArray& array, const ArrayHints& hints) {
  std::vector<std::size_t> possible;
  std::vector<std::size_t> timed;
  for (const std::size_t axis : {0U, 2U, 1U}) {
    const FrameShape shape = axes_of(array, axis).shape;
    if (axis == 1 && !hints.shape) break;
    if (!is_possible(shape) || (hints.shape && shape != *hints.shape)) continue;
    possible.push_back(axis);
    if (array.sizes[axis] == hints.times) timed.push_back(axis);
  }
  return timed.empty() ? possible : timed;
}

bool is_long_between(const NumberArray& array) {
  return array.sizes[1] >= kLopsidedMiddle * std::max({array.sizes[0], array.sizes[2], kFewestFrames});
}

bool is_doubtful(const NumberArray& array) {
  return (array.sizes[2] >= kFewestFrames && array.sizes[2] > array.sizes[0]) || is_long_between(array);
}

/// Frames between rows and cols change least along the middle axis.
bool may_stand_between(const NumberArray& array, std::span<const float> values) {
  if (!is_long_between(array) || values.empty()) return false;
  const double others = std::min(change_along(array, 0, values), change_along(array, 2, values));
  return change_along(array, 1, values) < kClearly * others;
}

/// Frames that stand last change least along the last axis. A long one is asked for, where frames do not clearly stand
/// first.
bool may_stand_last(const NumberArray& array, std::span<const float> values) {
  const bool is_lopsided = array.sizes[2] >= kLopsided * std::max(array.sizes[0], array.sizes[1]);
  if (values.empty()) return is_lopsided;
  const double last = change_along(array, 2, values);
  const double first = change_along(array, 0, values);
  if (last < kClearly * std::min(first, change_along(array, 1, values))) return true;
  return is_lopsided && !(first < kClearly * last);
}

std::string reading(const NumberArray& array, const ArrayHints& hints, std::size_t time) {
  const FrameAxes axes = axes_of(array, time);
  constexpr std::array kOrders = {"[frames, rows, cols]", "[rows, frames, cols]", "[rows, cols, frames]"};
  const std::string order = kOrders[time];
  return std::to_string(axes.frames) + " frames of " + size_text(axes.shape) + ", as " +
         in_quotes(hints.source + order);
}

Error both_ways(const NumberArray& array, const ArrayHints& hints, std::size_t time) {
  const std::string of_chosen = hints.axes.empty() ? "" : ", with the axes that are left after [" + hints.axes + "]";
  return bad_input("is " + array.sizes_text() + ", which can be read in two ways: " + reading(array, hints, 0) +
                   ", or " + reading(array, hints, time) + of_chosen);
}

Error not_this(const NumberArray& array, const ArrayHints& hints) {
  const FrameShape first = axes_of(array, 0).shape;
  if (!is_possible(first)) {
    return bad_input("has frames of " + std::to_string(first.rows) + "x" + std::to_string(first.cols) +
                     " taxels; 1x1 to 1024x1024 can be read");
  }
  return bad_input("has " + size_text(first) + " taxels, the array is " + size_text(*hints.shape));
}

Result<FrameAxes> axes_of_numbers(const NumberArray& array, const ArrayHints& hints) {
  const std::string has = "has frames of " + std::to_string(array.sizes[1]) + " numbers";
  if (!hints.shape) return bad_input(has + "; say how many rows and cols");
  if (const std::optional<FrameAxes> axes = axes_of_table(array, *hints.shape)) return *axes;
  return bad_input(has + ", the array is " + size_text(*hints.shape));
}

Result<FrameAxes> axes_that_were_told(const NumberArray& array, const ArrayHints& hints) {
  const FrameAxes axes = axes_of(array, 0);
  if (is_possible(axes.shape) && (!hints.shape || *hints.shape == axes.shape)) return axes;
  return not_this(array, hints);
}

NumberArray array_of(std::vector<std::size_t> sizes, bool is_last_fastest) {
  NumberArray array{std::move(sizes), {}, 0};
  array.steps.resize(array.sizes.size());
  std::size_t step = 1;
  for (std::size_t k = 0; k < array.sizes.size(); ++k) {
    const std::size_t axis = is_last_fastest ? array.sizes.size() - 1 - k : k;
    array.steps[axis] = step;
    step *= array.sizes[axis];
  }
  return array;
}

class ArrayFrames final : public FrameSource {
 public:
  ArrayFrames(std::string place, FrameAxes axes, std::vector<float> values, ArrayTimes times)
      : place_(std::move(place)), axes_(axes), values_(std::move(values)), times_(std::move(times)) {}

  Result<bool> next(RawFrame& frame) override {
    if (frame_ == axes_.frames) return false;
    const std::optional<Nanos> time =
        nanos_from_seconds(times_.rate_hz ? static_cast<double>(frame_) / *times_.rate_hz : times_.seconds[frame_]);
    if (!time) return no_time();
    frame.time = *time;
    frame.temperature_celsius.reset();
    frame.supply_v.reset();
    frame.acquisition = {};
    frame.counts.resize(axes_.shape.taxel_count());
    for (std::size_t taxel = 0; taxel < frame.counts.size(); ++taxel) {
      frame.counts[taxel] =
          values_[axes_.begin + frame_ * axes_.frame_step + taxel / axes_.shape.cols * axes_.row_step +
                  taxel % axes_.shape.cols * axes_.col_step];
    }
    ++frame_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return axes_.shape; }

 private:
  [[nodiscard]] Error no_time() const {
    if (times_.rate_hz) return bad_input(place_ + ": would be later than 9e9 seconds; give a higher rate");
    return bad_input(place_ + ": frame " + std::to_string(frame_) +
                     " has no time; seconds of at most 9e9 are expected");
  }

  std::string place_;
  FrameAxes axes_;
  std::vector<float> values_;
  ArrayTimes times_;
  std::size_t frame_ = 0;
};

}  // namespace

NumberArray NumberArray::last_fastest(std::vector<std::size_t> sizes) {
  return array_of(std::move(sizes), true);
}

NumberArray NumberArray::first_fastest(std::vector<std::size_t> sizes) {
  return array_of(std::move(sizes), false);
}

std::size_t NumberArray::value_count() const noexcept {
  std::size_t count = 1;
  for (const std::size_t size : sizes) {
    if (__builtin_mul_overflow(count, size, &count)) return std::numeric_limits<std::size_t>::max();
  }
  return count;
}

std::string NumberArray::sizes_text() const {
  std::string text;
  for (const std::size_t size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

bool FrameAxes::is_in_order() const noexcept {
  return begin == 0 && (col_step == 1 || shape.cols == 1) && (row_step == shape.cols || shape.rows == 1) &&
         (frame_step == shape.taxel_count() || frames == 1);
}

FrameAxes axes_of(const NumberArray& array, std::size_t time) {
  const std::size_t row = time == 0 ? 1 : 0;
  const std::size_t col = time == 2 ? 1 : 2;
  return {{array.sizes[row], array.sizes[col]},
          array.sizes[time],
          array.begin,
          array.steps[time],
          array.steps[row],
          array.steps[col]};
}

std::optional<FrameAxes> axes_of_table(const NumberArray& array, FrameShape shape) {
  const std::vector<std::size_t>& sizes = array.sizes;
  for (const std::size_t taxel : {1U, 0U}) {
    if (sizes[taxel] != shape.taxel_count()) continue;
    const std::size_t step = array.steps[taxel];
    return FrameAxes{shape, sizes[1 - taxel], array.begin, array.steps[1 - taxel], shape.cols * step, step};
  }
  if (sizes[0] != shape.rows || sizes[1] != shape.cols) return std::nullopt;
  return FrameAxes{shape, 1, array.begin, 0, array.steps[0], array.steps[1]};
}

std::optional<std::size_t> smoothest_axis(const NumberArray& array, const std::vector<std::size_t>& axes,
                                          std::span<const float> values) {
  std::vector<std::pair<double, std::size_t>> changes;
  for (const std::size_t axis : axes) changes.emplace_back(change_along(array, axis, values), axis);
  std::sort(changes.begin(), changes.end());
  const auto [least, axis] = changes[0];
  if (array.sizes[axis] >= kFewestFrames && least < kClearly * changes[1].first) return axis;
  return std::nullopt;
}

bool needs_values(const NumberArray& array, const ArrayHints& hints) {
  const Result<ChosenArray> chosen = choose_axes(array, hints);
  if (!chosen || chosen->is_told || chosen->array.sizes.size() != 3) return false;
  const std::vector<std::size_t> possible = possible_axes(chosen->array, hints);
  const bool is_between = !possible.empty() && !hints.shape && is_long_between(chosen->array);
  return (possible.size() > 1 || is_between) && is_doubtful(chosen->array) && array.value_count() <= kMostArrayValues;
}

Result<FrameAxes> frame_axes(const NumberArray& array, const ArrayHints& hints, std::span<const float> values) {
  const Result<ChosenArray> chosen = choose_axes(array, hints);
  if (!chosen) return chosen.error();
  const NumberArray& left = chosen->array;
  if (left.sizes.size() == 2) return axes_of_numbers(left, hints);
  if (chosen->is_told) return axes_that_were_told(left, hints);
  const std::vector<std::size_t> possible = possible_axes(left, hints);
  if (possible.empty()) return not_this(left, hints);
  if (!hints.shape && may_stand_between(left, values)) return both_ways(left, hints, 1);
  if (possible.size() > 1 && is_doubtful(left) && may_stand_last(left, values)) return both_ways(left, hints, 2);
  return axes_of(left, possible.front());
}

Result<std::vector<double>> seconds_of(std::vector<double> numbers, double unit_s) {
  constexpr double kLatest = 9e9;
  constexpr double kLongest = 1.0;
  double largest = 0.0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  const bool is_named = unit_s > 0.0;
  if (!is_named) unit_s = 1.0;
  if (!is_named) {
    while (largest * unit_s > kLatest && unit_s > 1e-9) unit_s *= 1e-3;
  }
  const bool is_guessed = !is_named && unit_s == 1.0 && numbers.size() > 1;
  const double mean = is_guessed ? (numbers.back() - numbers.front()) / static_cast<double>(numbers.size() - 1) : 0.0;
  if (mean >= kLongest) {
    return bad_input("go on by " + std::to_string(mean) +
                     " from frame to frame, in a unit that nothing tells: name them time_s or time_ns, or give a rate");
  }
  for (double& number : numbers) number *= unit_s;
  return numbers;
}

std::unique_ptr<FrameSource> frames_of_array(std::string place, FrameAxes axes, std::vector<float> values,
                                             ArrayTimes times) {
  return std::make_unique<ArrayFrames>(std::move(place), axes, std::move(values), std::move(times));
}

}  // namespace dermis::bytes::files
