// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace dermis::report {
namespace {

double distance_to(Point point, Point from, Point to) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double length_squared = dx * dx + dy * dy;
  const double along =
      length_squared > 0.0 ? ((point.x - from.x) * dx + (point.y - from.y) * dy) / length_squared : 0.0;
  const double share = std::clamp(along, 0.0, 1.0);
  return std::hypot(point.x - from.x - share * dx, point.y - from.y - share * dy);
}

struct Box {
  double left = std::numeric_limits<double>::infinity();
  double top = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double bottom = -std::numeric_limits<double>::infinity();

  void add(Point point, double margin) {
    left = std::min(left, point.x - margin);
    top = std::min(top, point.y - margin);
    right = std::max(right, point.x + margin);
    bottom = std::max(bottom, point.y + margin);
  }
};

/// Whole pixels from `low` to `high`, inside the picture.
std::pair<std::size_t, std::size_t> pixels_in(double low, double high, std::size_t count) {
  const auto last = static_cast<double>(count);
  return {static_cast<std::size_t>(std::clamp(std::floor(low), 0.0, last)),
          static_cast<std::size_t>(std::clamp(std::ceil(high), 0.0, last))};
}

/// How much of each pixel in a box is covered by lines: where two meet, no more than by one.
class Cover {
 public:
  Cover(const Box& box, std::size_t width, std::size_t height) {
    std::tie(left_, right_) = pixels_in(box.left, box.right, width);
    std::tie(top_, bottom_) = pixels_in(box.top, box.bottom, height);
    shares_.assign((right_ - left_) * (bottom_ - top_), 0.0);
  }

  void add(Point from, Point to, double half_width) {
    Box box;
    box.add(from, half_width + 1.0);
    box.add(to, half_width + 1.0);
    const auto [left, right] = pixels_in(box.left, box.right, right_);
    const auto [top, bottom] = pixels_in(box.top, box.bottom, bottom_);
    for (std::size_t y = std::max(top, top_); y < bottom; ++y) {
      for (std::size_t x = std::max(left, left_); x < right; ++x) {
        const Point centre{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
        double& share = shares_[(y - top_) * (right_ - left_) + x - left_];
        share = std::max(share, std::clamp(half_width + 0.5 - distance_to(centre, from, to), 0.0, 1.0));
      }
    }
  }

  template <typename Paint>
  void for_each(const Paint& paint) const {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      if (shares_[i] > 0.0) paint(left_ + i % (right_ - left_), top_ + i / (right_ - left_), shares_[i]);
    }
  }

 private:
  std::size_t left_ = 0;
  std::size_t right_ = 0;
  std::size_t top_ = 0;
  std::size_t bottom_ = 0;
  std::vector<double> shares_;
};

}  // namespace

Raster::Raster(double width, double height, double scale, Colour background) : scale_(scale) {
  pixels_.width = static_cast<std::size_t>(std::ceil(width * scale));
  pixels_.height = static_cast<std::size_t>(std::ceil(height * scale));
  pixels_.rgb.reserve(3 * pixels_.width * pixels_.height);
  for (std::size_t i = 0; i < pixels_.width * pixels_.height; ++i) {
    pixels_.rgb.insert(pixels_.rgb.end(), {background.red, background.green, background.blue});
  }
}

void Raster::blend(std::size_t x, std::size_t y, Colour colour, double share) {
  std::uint8_t* pixel = &pixels_.rgb[3 * (y * pixels_.width + x)];
  const auto mixed = [&](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(
        std::lround(static_cast<double>(below) * (1.0 - share) + static_cast<double>(above) * share));
  };
  pixel[0] = mixed(pixel[0], colour.red);
  pixel[1] = mixed(pixel[1], colour.green);
  pixel[2] = mixed(pixel[2], colour.blue);
}

/// Edges lie on whole pixels: neighbours touch without a seam.
void Raster::fill(Point corner, double width, double height, Colour colour) {
  const auto edge = [&](double length) { return std::round(length * scale_); };
  const auto [left, right] = pixels_in(edge(corner.x), edge(corner.x + width), pixels_.width);
  const auto [top, bottom] = pixels_in(edge(corner.y), edge(corner.y + height), pixels_.height);
  for (std::size_t y = top; y < bottom; ++y) {
    for (std::size_t x = left; x < right; ++x) {
      std::uint8_t* pixel = &pixels_.rgb[3 * (y * pixels_.width + x)];
      pixel[0] = colour.red;
      pixel[1] = colour.green;
      pixel[2] = colour.blue;
    }
  }
}

void Raster::stroke(std::span<const std::vector<Point>> lines, double line_width, Colour colour) {
  const double half = 0.5 * line_width * scale_;
  Box box;
  for (const std::vector<Point>& line : lines) {
    for (const Point& point : line) box.add({point.x * scale_, point.y * scale_}, half + 1.0);
  }
  Cover cover(box, pixels_.width, pixels_.height);
  for (const std::vector<Point>& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      cover.add({line[i].x * scale_, line[i].y * scale_}, {line[i + 1].x * scale_, line[i + 1].y * scale_}, half);
    }
  }
  cover.for_each([&](std::size_t x, std::size_t y, double share) { blend(x, y, colour, share); });
}

}  // namespace dermis::report
