// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "dermis/out/report/canvas.hpp"
#include "out/report/palette.hpp"

namespace dermis::out::report {
namespace {

constexpr double kWidth = 270.0;
constexpr double kLeft = 34.0;
constexpr double kTop = 44.0;
constexpr double kLargestSide = 168.0;  // Of the array [px].
constexpr double kSmallestSide = 6.0;   // So that a single long row can still be seen.
constexpr double kBottom = 26.0;
// With axes, where the picture has the width of a page's third.
constexpr double kAxesWidth = 346.0;
constexpr double kAxesLargestSide = 244.0;
constexpr double kAxesTop = 26.0;
constexpr double kAxesBottom = 40.0;
constexpr double kBarGap = 10.0;
constexpr double kBarWidth = 10.0;
constexpr double kLeastBarHeight = 90.0;
constexpr std::size_t kBarSteps = 64;
constexpr std::size_t kColours = 256;
constexpr std::size_t kMostTicks = 6;

/// Gamma-encodes a linear sRGB component.
std::uint8_t encoded(double linear) {
  const double inside = std::clamp(linear, 0.0, 1.0);
  const double srgb = inside <= 0.0031308 ? 12.92 * inside : 1.055 * std::pow(inside, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * srgb));
}

Colour from_oklab(double lightness, double a, double b) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Colour from_oklch(double lightness, double chroma, double hue_degrees) {
  const double hue = hue_degrees * std::numbers::pi / 180.0;
  return from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

/// Where in the palette a share of the scale lies.
double palette_place(double share) {
  if (share < kToeShare) return kToeColours * std::pow(share / kToeShare, 3.0);
  return kToeColours + (share - kToeShare) * (1.0 - kToeColours) / (1.0 - kToeShare);
}

std::uint8_t palette_part(std::size_t part, double place) {
  double value = 0.0;
  for (std::size_t power = kPalette.size(); power-- > 0;) value = value * place + kPalette[power][part];
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

std::string fill(Colours colours, std::size_t level) {
  const double share = static_cast<double>(level) / static_cast<double>(kColours - 1);
  return to_hex(colours == Colours::diverging ? diverging_colour(2.0 * share - 1.0) : sequential_colour(share));
}

class Painter {
 public:
  explicit Painter(const HeatMap& map)
      : map_(map), low_(map.colours == Colours::diverging ? -map.high : 0.0), top_(map.axes ? kAxesTop : kTop) {
    const double width = static_cast<double>(map.cols) * map.col_pitch;
    const double height = static_cast<double>(map.rows) * map.row_pitch;
    const double scale = (map.axes ? kAxesLargestSide : kLargestSide) / std::max(width, height);
    width_ = std::max(width * scale, kSmallestSide);
    height_ = std::max(height * scale, kSmallestSide);
  }

  Drawing paint() && {
    canvas_.text("title", Anchor::start, {kLeft, 16.0}, map_.title);
    draw_cells();
    canvas_.rectangle("frame", {kLeft, top_}, width_, height_);
    map_.axes ? draw_axes(*map_.axes) : draw_lines();
    draw_scale();
    const double height = top_ + bar_height() + (map_.axes ? kAxesBottom : kBottom);
    return {map_.axes ? kAxesWidth : kWidth, height, map_.title, std::move(canvas_).take()};
  }

 private:
  [[nodiscard]] double bar_height() const { return std::max(height_, kLeastBarHeight); }
  [[nodiscard]] double left_of(std::size_t col) const {
    return kLeft + width_ * static_cast<double>(col) / static_cast<double>(map_.cols);
  }
  /// Upper edge of a line of the picture, from 0 at the top.
  [[nodiscard]] double top_of(std::size_t line) const {
    return top_ + height_ * static_cast<double>(line) / static_cast<double>(map_.rows);
  }

  /// 0 ... kColours - 1, or kColours for a value that is not finite.
  [[nodiscard]] std::size_t level(std::size_t line, std::size_t col) const {
    const std::size_t row = map_.axes ? map_.rows - 1 - line : line;
    const double value = map_.values[row * map_.cols + col];
    if (!std::isfinite(value)) return kColours;
    const double share = std::clamp((value - low_) / (map_.high - low_), 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(share * static_cast<double>(kColours - 1)));
  }

  /// One path a colour; neighbours of one colour in a row are one rectangle of it. Large arrays stay small files.
  void draw_cells() {
    std::map<std::size_t, std::string> rectangles;
    std::string crosses;
    for (std::size_t row = 0; row < map_.rows; ++row) {
      for (std::size_t col = 0; col < map_.cols;) {
        const std::size_t first = col;
        const std::size_t colour = level(row, first);
        while (col < map_.cols && level(row, col) == colour) ++col;
        rectangles[colour] += cell_path(row, first, col);
        for (std::size_t i = first; colour == kColours && i < col; ++i) crosses += cross_path(row, i);
      }
    }
    for (const auto& [colour, data] : rectangles) draw_colour(colour, data);
    canvas_.path("cross", crosses);
  }

  void draw_colour(std::size_t colour, const std::string& data) {
    colour == kColours ? canvas_.path("nothing", data) : canvas_.filled_path("cell", fill(map_.colours, colour), data);
  }

  [[nodiscard]] std::string cell_path(std::size_t row, std::size_t first, std::size_t end) const {
    return move_to({left_of(first), top_of(row)}) + "H" + coordinate(left_of(end)) + "V" + coordinate(top_of(row + 1)) +
           "H" + coordinate(left_of(first)) + "z";
  }

  [[nodiscard]] std::string cross_path(std::size_t row, std::size_t col) const {
    const Point from{left_of(col), top_of(row)};
    const Point to{left_of(col + 1), top_of(row + 1)};
    return move_to(from) + line_to(to) + move_to({from.x, to.y}) + line_to({to.x, from.y});
  }

  /// Names of the first and last lines: "c0" and "c15" above, "r0" and "r15" at the left.
  void draw_lines() {
    const auto column = [&](std::size_t col) {
      const Point place{(left_of(col) + left_of(col + 1)) / 2.0, top_ - 6.0};
      canvas_.text("small muted", Anchor::middle, place, "c" + std::to_string(col));
    };
    const auto row = [&](std::size_t line) {
      const Point place{kLeft - 5.0, (top_of(line) + top_of(line + 1)) / 2.0 + 4.0};
      canvas_.text("small muted", Anchor::end, place, "r" + std::to_string(line));
    };
    column(0);
    row(0);
    if (width_ > 48.0 && map_.cols > 1) column(map_.cols - 1);
    if (height_ > 28.0 && map_.rows > 1) row(map_.rows - 1);
  }

  void draw_axes(const MapAxes& axes) {
    const double bottom = top_ + height_;
    for (const double tick : axes.x.ticks) {
      const double x = kLeft + axes.x.position(tick) * width_;
      canvas_.line("tick", {x, bottom}, {x, bottom + 4.0});
      canvas_.text("small", Anchor::middle, {x, bottom + 16.0}, tick_label(tick));
    }
    for (const double tick : axes.y.ticks) {
      const double y = bottom - axes.y.position(tick) * height_;
      canvas_.line("tick", {kLeft - 4.0, y}, {kLeft, y});
      canvas_.text("small", Anchor::end, {kLeft - 6.0, y + 4.0}, tick_label(tick));
    }
    canvas_.text("muted", Anchor::middle, {kLeft + width_ / 2.0, bottom + 32.0}, axes.x.label);
    canvas_.upright_text("muted", {11.0, top_ + height_ / 2.0}, axes.y.label);
  }

  void draw_scale() {
    const double left = kLeft + std::max(width_, 40.0) + kBarGap;
    const double step = bar_height() / static_cast<double>(kBarSteps);
    for (std::size_t i = 0; i < kBarSteps; ++i) {
      const double top = top_ + bar_height() - step * static_cast<double>(i + 1);
      const std::string data = move_to({left, top}) + "h" + coordinate(kBarWidth) + "V" + coordinate(top + step) + "H" +
                               coordinate(left) + "z";
      canvas_.filled_path("cell", fill(map_.colours, i * (kColours - 1) / (kBarSteps - 1)), data);
    }
    canvas_.rectangle("frame", {left, top_}, kBarWidth, bar_height());
    for (const double tick : linear_ticks(low_, map_.high, kMostTicks)) {
      const double y = top_ + bar_height() * (1.0 - (tick - low_) / (map_.high - low_));
      canvas_.line("tick", {left + kBarWidth, y}, {left + kBarWidth + 4.0, y});
      canvas_.text("small", Anchor::start, {left + kBarWidth + 7.0, y + 4.0}, tick_label(tick));
    }
  }

  const HeatMap& map_;
  double low_;  // Start of the colour scale.
  double top_;
  Canvas canvas_;
  double width_ = 0.0;
  double height_ = 0.0;
};

}  // namespace

Colour sequential_colour(double share) noexcept {
  const double place = palette_place(std::clamp(share, 0.0, 1.0));
  return {palette_part(0, place), palette_part(1, place), palette_part(2, place)};
}

Colour diverging_colour(double share) noexcept {
  const double t = std::min(std::abs(share), 1.0);
  const double chroma = 0.4 * t * (1.0 - 0.73 * t);  // Inside the gamut of sRGB all along.
  return from_oklch(0.965 - 0.575 * t, chroma, share < 0.0 ? 260.0 : 45.0);
}

std::string to_hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

double heat_map_high(const std::vector<double>& values) noexcept {
  double high = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) high = std::max(high, value);
  }
  return high > 0.0 ? high : 1.0;
}

Drawing heat_map(const HeatMap& map) {
  assert(map.rows >= 1 && map.cols >= 1 && map.values.size() == map.rows * map.cols);
  assert(map.high > 0.0 && std::isfinite(map.high));
  return Painter(map).paint();
}

}  // namespace dermis::out::report
