// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/out/report/plot.hpp"

namespace dermis::out::report {
namespace {

constexpr std::size_t kMostLinearTicks = 6;
constexpr int kMostLogTicks = 12;

// Beyond these, differences and ratios of values could leave the range of a double.
constexpr double kLargest = 1e100;
constexpr double kSmallest = 1e-100;

struct Range {
  double low;
  double high;
};

int decade_of(int index) {
  return index >= 0 ? index / 3 : -((2 - index) / 3);
}

/// factor * 1, 2, 5, 10, 20 for index 0, 1, 2, 3, 4, and so on. Below 0 it goes on with 0.5, 0.2, 0.1, and so on.
/// Negative powers divide, so that 3 * 0.1 is the double that is written 0.3.
double on_grid(double factor, int index) {
  constexpr std::array<double, 3> kMantissas = {1.0, 2.0, 5.0};
  const int decade = decade_of(index);
  const double mantissa = factor * kMantissas[static_cast<std::size_t>(index - 3 * decade)];
  return decade >= 0 ? mantissa * std::pow(10.0, decade) : mantissa / std::pow(10.0, -decade);
}

/// The largest index with on_grid(1, index) <= value.
int grid_index_below(double value) {
  int index = 3 * static_cast<int>(std::floor(std::log10(value)));
  while (on_grid(1.0, index) > value) --index;
  while (on_grid(1.0, index + 1) <= value) ++index;
  return index;
}

/// The smallest index with on_grid(1, index) >= value.
int grid_index_above(double value) {
  const int index = grid_index_below(value);
  return on_grid(1.0, index) < value ? index + 1 : index;
}

/// First and last whole multiple of `step` in [low, high], with a little room for rounding.
Range multiples_inside(double low, double high, double step) {
  constexpr double kRoom = 1e-9;
  return {std::ceil(low / step - kRoom) + 0.0, std::floor(high / step + kRoom)};  // + 0.0: never -0
}

Range multiples_around(double low, double high, double step) {
  constexpr double kRoom = 1e-9;
  return {std::floor(low / step + kRoom) + 0.0, std::ceil(high / step - kRoom)};
}

int step_index(double low, double high, std::size_t most) {
  int index = grid_index_below((high - low) / static_cast<double>(most));
  const auto ticks = [&] {
    const Range factors = multiples_inside(low, high, on_grid(1.0, index));
    return factors.high - factors.low + 1.0;
  };
  while (ticks() > static_cast<double>(most)) ++index;
  return index;
}

std::vector<double> multiples_on_grid(Range factors, int index) {
  std::vector<double> ticks;
  const auto count = static_cast<int>(factors.high - factors.low) + 1;
  for (int i = 0; i < count; ++i) ticks.push_back(on_grid(factors.low + i, index));
  return ticks;
}

bool is_usable(double value, Scale scale) {
  return std::abs(value) <= kLargest && (scale == Scale::linear || value >= kSmallest);
}

Range range_of(Scale scale, std::span<const double> values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Range range{kInfinity, -kInfinity};
  for (const double value : values) {
    if (is_usable(value, scale)) range = {std::min(range.low, value), std::max(range.high, value)};
  }
  return range.low <= range.high ? range : Range{1.0, 1.0};
}

/// A range that is one point is given a width.
Range widened(Range range) {
  const double magnitude = std::max(std::abs(range.low), std::abs(range.high));
  if (range.high - range.low > std::max(1e-9 * magnitude, kSmallest)) return range;
  const double margin = magnitude > kSmallest ? 0.05 * magnitude : 1.0;
  return {range.low - margin, range.high + margin};
}

void fit_linear(Axis& axis, Range range) {
  const int index = step_index(range.low, range.high, kMostLinearTicks);
  axis.ticks = multiples_on_grid(multiples_around(range.low, range.high, on_grid(1.0, index)), index);
  axis.low = axis.ticks.front();
  axis.high = axis.ticks.back();
}

void fit_logarithmic(Axis& axis, Range range) {
  constexpr double kRoom = 1e-3;  // 50.0001 does not ask for an axis up to 100.
  const int first = grid_index_below(range.low * (1.0 + kRoom));
  const int last = std::max(grid_index_above(range.high * (1.0 - kRoom)), first + 1);
  axis.low = on_grid(1.0, first);
  axis.high = on_grid(1.0, last);
  axis.ticks = log_ticks(axis.low, axis.high);
}

}  // namespace

std::vector<double> linear_ticks(double low, double high, std::size_t most) {
  assert(low < high && most >= 2);
  const int index = step_index(low, high, most);
  return multiples_on_grid(multiples_inside(low, high, on_grid(1.0, index)), index);
}

std::vector<double> log_ticks(double low, double high) {
  assert(low > 0.0 && low < high);
  int first = grid_index_above(low);
  const int last = grid_index_below(high);
  int step = 1;
  if (last - first + 1 > kMostLogTicks) {
    first = 3 * decade_of(first + 2);
    const int decades = (last - first) / 3 + 1;
    step = 3 * ((decades + kMostLogTicks - 1) / kMostLogTicks);
  }
  std::vector<double> ticks;
  for (int index = first; index <= last; index += step) ticks.push_back(on_grid(1.0, index));
  return ticks;
}

double Axis::position(double value) const noexcept {
  if (std::isnan(value)) return value;
  const double inside = std::clamp(value, low, high);
  if (scale == Scale::linear) return (inside - low) / (high - low);
  return std::log(inside / low) / std::log(high / low);
}

Axis nice_axis(std::string label, Scale scale, std::span<const double> values) {
  Axis axis;
  axis.label = std::move(label);
  axis.scale = scale;
  const Range range = range_of(scale, values);
  if (scale == Scale::linear) {
    fit_linear(axis, widened(range));
  } else {
    fit_logarithmic(axis, range);
  }
  return axis;
}

}  // namespace dermis::out::report
