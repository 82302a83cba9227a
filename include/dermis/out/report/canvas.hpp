// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/out/report/plot.hpp"

namespace dermis::out::report {

enum class Anchor { start, middle, end };

/// Writes SVG elements. Classes are those of figure_css(); every coordinate is finite.
class Canvas {
 public:
  void line(std::string_view style, Point from, Point to);
  void rectangle(std::string_view style, Point corner, double width, double height);
  /// `data` is a path of SVG.
  void path(std::string_view style, std::string_view data);
  void filled_path(std::string_view style, std::string_view colour, std::string_view data);
  void text(std::string_view style, Anchor anchor, Point place, std::string_view words);
  /// Reads from bottom to top.
  void upright_text(std::string_view style, Point centre, std::string_view words);
  void open_group(std::string_view style);
  void close_group();

  [[nodiscard]] std::string take() && { return std::move(elements_); }

 private:
  std::string elements_;
};

/// A length for an SVG attribute, to 1/100 px.
[[nodiscard]] std::string coordinate(double value);

/// "M x y": the start of a path.
[[nodiscard]] std::string move_to(Point point);
[[nodiscard]] std::string line_to(Point point);

/// The mark of a series as path data, about 7 px across: circle, square, triangle, ...
[[nodiscard]] std::string mark(std::size_t style, Point centre);

/// "s3": the class of a series, which sets its colour.
[[nodiscard]] std::string series_class(std::size_t style);

/// Width of a small text of the drawings [px], estimated from its characters.
[[nodiscard]] double text_width(std::string_view words);

/// A number as on a tick of an axis.
[[nodiscard]] std::string tick_label(double value);

}  // namespace dermis::out::report
