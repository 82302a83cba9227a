// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "dermis/report/heat_map.hpp"
#include "dermis/report/plot.hpp"
#include "dermis/report/png.hpp"

namespace dermis::report {

/// Draws into pixels. Lengths are those of a drawing times `scale`.
class Raster {
 public:
  Raster(double width, double height, double scale, Colour background);

  void fill(Point corner, double width, double height, Colour colour);
  /// Lines from point to point, smooth at the edges.
  void stroke(std::span<const std::vector<Point>> lines, double line_width, Colour colour);

  [[nodiscard]] Pixels take() && { return std::move(pixels_); }

 private:
  void blend(std::size_t x, std::size_t y, Colour colour, double share);

  Pixels pixels_;
  double scale_;
};

/// Lines of a text in a plotter's hand. `size` is the height of a capital; the point is the left end of the base line.
/// Unknown letters are boxes.
[[nodiscard]] std::vector<std::vector<Point>> text_strokes(std::string_view text, Point place, double size);
[[nodiscard]] double stroke_text_width(std::string_view text, double size);

}  // namespace dermis::report
