// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "dermis/out/report/canvas.hpp"
#include "dermis/out/report/heat_map.hpp"

namespace dermis::paper {

using out::report::Anchor;
using out::report::Canvas;
using out::report::diverging_colour;
using out::report::Drawing;
using out::report::line_to;
using out::report::move_to;
using out::report::Point;
using out::report::tick_label;
using out::report::to_hex;

namespace {

constexpr double kWidth = 480.0;
constexpr double kHeight = 368.0;
constexpr double kSide = 252.0;     // Of the floor [px].
constexpr double kTallness = 0.58;  // Height of the box, in sides of the floor.
constexpr Point kCentre{254.0, 182.0};

struct Place {
  double x;  // In the box: 0 ... 1.
  double y;
  double z;
};

class Painter {
 public:
  explicit Painter(const Surface& surface) : surface_(surface) {}

  Drawing paint() && {
    canvas_.text("title", Anchor::start, {20.0, 16.0}, surface_.title);
    draw_walls();
    draw_facets();
    draw_ticks();
    return {kWidth, kHeight, surface_.title + ": a surface in space", std::move(canvas_).take()};
  }

 private:
  /// From the side of small x and small y, from above.
  static Point project(Place place) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    static const double kCosAzimuth = std::cos(-37.5 * kDegree);
    static const double kSinAzimuth = std::sin(-37.5 * kDegree);
    static const double kSinElevation = std::sin(30.0 * kDegree);
    static const double kCosElevation = std::cos(30.0 * kDegree);
    const double x = place.x - 0.5;
    const double y = place.y - 0.5;
    const double right = kCosAzimuth * x + kSinAzimuth * y;
    const double away = kCosAzimuth * y - kSinAzimuth * x;
    const double up = kTallness * (place.z - 0.5) * kCosElevation + away * kSinElevation;
    return {kCentre.x + kSide * right, kCentre.y - kSide * up};
  }

  static std::string segment(Place from, Place to) { return move_to(project(from)) + line_to(project(to)); }

  /// The floor and the two walls behind, with the lines of the ticks.
  void draw_walls() {
    std::string grid;
    for (const double tick : surface_.x.ticks) {
      const double x = surface_.x.position(tick);
      grid += segment({x, 0, 0}, {x, 1, 0}) + segment({x, 1, 0}, {x, 1, 1});
    }
    for (const double tick : surface_.y.ticks) {
      const double y = surface_.y.position(tick);
      grid += segment({0, y, 0}, {1, y, 0}) + segment({1, y, 0}, {1, y, 1});
    }
    for (const double tick : surface_.z.ticks) {
      const double z = surface_.z.position(tick);
      grid += segment({0, 1, z}, {1, 1, z}) + segment({1, 1, z}, {1, 0, z});
    }
    canvas_.path("grid", grid);
    canvas_.path("frame", segment({0, 1, 0}, {0, 0, 0}) + segment({0, 0, 0}, {1, 0, 0}) +
                              segment({0, 1, 0}, {0, 1, 1}) + segment({0, 1, 1}, {1, 1, 1}) +
                              segment({1, 1, 1}, {1, 0, 1}) + segment({1, 0, 1}, {1, 0, 0}));
  }

  /// Painter's algorithm: what is farthest comes first, and that is the highest row and column.
  void draw_facets() {
    for (std::size_t row = surface_.rows - 1; row-- > 0;) {
      for (std::size_t col = surface_.cols - 1; col-- > 0;) draw_facet(row, col);
    }
  }

  void draw_facet(std::size_t row, std::size_t col) {
    const std::array<double, 4> corners = {value(row, col), value(row, col + 1), value(row + 1, col + 1),
                                           value(row + 1, col)};
    if (!std::all_of(corners.begin(), corners.end(), [](double corner) { return std::isfinite(corner); })) return;
    const double high = std::max(std::abs(surface_.z.low), std::abs(surface_.z.high));
    const double mean = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
    canvas_.filled_path("facet", to_hex(diverging_colour(mean / high)),
                        move_to(project(place(row, col))) + line_to(project(place(row, col + 1))) +
                            line_to(project(place(row + 1, col + 1))) + line_to(project(place(row + 1, col))) + "z");
  }

  [[nodiscard]] double value(std::size_t row, std::size_t col) const {
    return surface_.values[row * surface_.cols + col];
  }

  [[nodiscard]] Place place(std::size_t row, std::size_t col) const {
    return {static_cast<double>(col) / static_cast<double>(surface_.cols - 1),
            static_cast<double>(row) / static_cast<double>(surface_.rows - 1), surface_.z.position(value(row, col))};
  }

  /// x and y along the front edges of the floor, z at the left.
  void draw_ticks() {
    for (const double tick : surface_.x.ticks) {
      const Point at = project({surface_.x.position(tick), 0, 0});
      canvas_.text("small", Anchor::start, {at.x + 4.0, at.y + 14.0}, tick_label(tick));
    }
    for (const double tick : surface_.y.ticks) {
      const Point at = project({0, surface_.y.position(tick), 0});
      canvas_.text("small", Anchor::end, {at.x - 4.0, at.y + 14.0}, tick_label(tick));
    }
    for (const double tick : surface_.z.ticks) {
      const Point at = project({0, 1, surface_.z.position(tick)});
      canvas_.line("tick", {at.x - 4.0, at.y}, at);
      canvas_.text("small", Anchor::end, {at.x - 7.0, at.y + 4.0}, tick_label(tick));
    }
    const Point x = project({0.5, 0, 0});
    const Point y = project({0, 0.5, 0});
    canvas_.text("muted", Anchor::start, {x.x + 16.0, x.y + 30.0}, surface_.x.label);
    canvas_.text("muted", Anchor::end, {y.x - 16.0, y.y + 30.0}, surface_.y.label);
    const Point z = project({0, 1, 0.5});
    canvas_.upright_text("muted", {z.x - 44.0, z.y}, surface_.z.label);
  }

  const Surface& surface_;
  Canvas canvas_;
};

}  // namespace

Drawing surface(const Surface& surface) {
  assert(surface.rows >= 2 && surface.cols >= 2 && surface.values.size() == surface.rows * surface.cols);
  return Painter(surface).paint();
}

}  // namespace dermis::paper
