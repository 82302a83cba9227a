// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/out/report/canvas.hpp"
#include "dermis/out/report/heat_map.hpp"
#include "dermis/out/report/plot.hpp"

namespace dermis::out::report {

/// The colours of labels, and of marks on any ground.
constexpr Colour kMark{255, 255, 255};
constexpr Colour kMarkEdge{20, 20, 24};
constexpr double kLabelEdge = 3.0;  ///< Its width on both sides of a line together.

/// The tools for painting a picture.
class Brush {
 public:
  Brush() = default;
  Brush(const Brush&) = delete;
  Brush& operator=(const Brush&) = delete;
  virtual ~Brush() = default;

  virtual void fill(Point corner, double width, double height, Colour colour) = 0;
  virtual void lines(const std::vector<std::vector<Point>>& lines, double width, Colour colour) = 0;
  /// `size` is the height of a capital.
  virtual void text(Anchor anchor, Point place, double size, Colour colour, const std::string& words) = 0;
  /// A text with an edge, which can be read on any ground.
  virtual void label(Point centre, double size, const std::string& words) = 0;

 protected:
  /// Size of a sans-serif face whose capitals have this height.
  [[nodiscard]] static double font_size(double capital) { return capital / 0.72; }
};

}  // namespace dermis::out::report
