// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/smoothness.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bytes/proposals/shapes.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostFrames = 24;  // looked at
constexpr double kLongest = 8.0;         // times as many rows as columns, or the other way round
constexpr double kAsSmooth = 1.1;        // times the least difference is as good
constexpr double kSurely = 3.0;          // standard errors

/// A mean, and the square of its standard error.
struct Mean {
  double value = 0.0;
  double squared_error = 0.0;
};

/// Mean difference of readings that lie `lag` apart.
Mean difference_at(const Readings& frames, std::size_t lag) {
  double sum = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (const std::vector<float>& frame : frames) {
    for (std::size_t i = lag; i < frame.size(); ++i) {
      const double difference = std::abs(static_cast<double>(frame[i]) - static_cast<double>(frame[i - lag]));
      if (!std::isfinite(difference)) continue;
      sum += difference;
      squares += difference * difference;
      ++count;
    }
  }
  if (count == 0) return {};
  const auto n = static_cast<double>(count);
  return {sum / n, (squares / n - (sum / n) * (sum / n)) / n};
}

/// Mean difference of two readings at random places of all frames.
double difference_of_any(const Readings& frames) {
  std::vector<float> all;
  for (const std::vector<float>& frame : frames) all.insert(all.end(), frame.begin(), frame.end());
  std::erase_if(all, [](float value) { return !std::isfinite(value); });
  std::sort(all.begin(), all.end());
  double sum = 0.0;  // Gini's mean difference
  const auto count = static_cast<double>(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    sum += (2.0 * static_cast<double>(i) + 1.0 - count) * static_cast<double>(all[i]);
  return all.size() > 1 ? 2.0 * sum / (count * (count - 1.0)) : 0.0;
}

double relative(double difference, const Readings& frames) {
  const double any = difference_of_any(frames);
  return any > 0.0 ? difference / any : 0.0;
}

struct Judged {
  FrameShape shape;
  Mean difference;
};

/// How much the readings of each shape that so many taxels may have differ from one row to the next.
std::vector<Judged> judged_shapes(const Readings& frames, std::size_t taxels, const Known& known) {
  std::vector<Judged> all;
  for (std::size_t rows = 1; rows <= taxels && rows <= 1024; ++rows) {
    const FrameShape shape{rows, taxels / rows};
    if (taxels % rows != 0 || shape.cols > 1024 || !is_known(shape, known)) continue;
    const double ratio = static_cast<double>(rows) / static_cast<double>(shape.cols);
    const bool is_line = rows == 1 || shape.cols == 1;
    const bool is_asked = known.rows || known.cols;
    if (!is_asked && ((!is_line && (ratio > kLongest || ratio < 1.0 / kLongest)) || (is_line && rows > 1))) continue;
    all.push_back({shape, difference_at(frames, shape.rows > 1 ? shape.cols : 1)});
    if (shape.rows == 1) all.back().difference.value *= kAsSmooth;
  }
  return all;
}

/// Whether one is less smooth than the smoothest by more than noise makes it.
bool is_rougher(const Mean& one, const Mean& smoothest) {
  const double noise = kSurely * std::sqrt(one.squared_error + smoothest.squared_error);
  return one.value > std::max(kAsSmooth * smoothest.value, smoothest.value + noise);
}

}  // namespace

double roughness_along(const Readings& frames) {
  return relative(difference_at(frames, 1).value, frames);
}

double roughness_in_time(const Readings& frames) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const std::size_t size = std::min(frames[k].size(), frames[k - 1].size());
    for (std::size_t i = 0; i < size; ++i) {
      const double difference = std::abs(static_cast<double>(frames[k][i]) - static_cast<double>(frames[k - 1][i]));
      if (!std::isfinite(difference)) continue;
      sum += difference;
      ++count;
    }
  }
  return count > 0 ? relative(sum / static_cast<double>(count), frames) : 1.0;
}

std::vector<FrameShape> likely_shapes(const Readings& frames, std::size_t taxels, const Known& known) {
  const Readings looked(frames.begin(),
                        frames.begin() + static_cast<std::ptrdiff_t>(std::min(frames.size(), kMostFrames)));
  std::vector<Judged> all = judged_shapes(looked, taxels, known);
  const auto least = std::min_element(
      all.begin(), all.end(), [](const Judged& a, const Judged& b) { return a.difference.value < b.difference.value; });
  const Mean smoothest = all.empty() ? Mean() : least->difference;
  const auto rank = [&](const Judged& one) {
    const auto [shorter, longer] = std::minmax(one.shape.rows, one.shape.cols);
    const double ratio = static_cast<double>(longer) / static_cast<double>(shorter);
    const bool has_fewer_rows = one.shape.rows < one.shape.cols;
    const bool rougher = is_rougher(one.difference, smoothest);
    return std::tuple(rougher, rougher ? one.difference.value : ratio, has_fewer_rows);
  };
  std::stable_sort(all.begin(), all.end(), [&](const Judged& a, const Judged& b) { return rank(a) < rank(b); });
  std::vector<FrameShape> shapes;
  for (const Judged& one : all) shapes.push_back(one.shape);
  return shapes;
}

}  // namespace dermis::bytes::proposals
