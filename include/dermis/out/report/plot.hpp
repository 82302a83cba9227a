// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/out/report/svg.hpp"

namespace dermis::out::report {

enum class Scale { linear, logarithmic };

/// The multiples of 1, 2 or 5 times a power of ten inside [low, high]. The step is the finest that gives at most `most`
/// of them (`most` >= 2). low < high, both finite.
[[nodiscard]] std::vector<double> linear_ticks(double low, double high, std::size_t most);

/// 1, 2 and 5 times the powers of ten inside [low, high]. If that is more than twelve, only powers of ten, evenly
/// thinned out. 0 < low < high, both finite.
[[nodiscard]] std::vector<double> log_ticks(double low, double high);

/// One axis of a plot.
struct Axis {
  std::string label;  ///< With its unit: "true force [N]".
  Scale scale = Scale::linear;
  double low = 0.0;  ///< low < high, both finite; low > 0 where logarithmic.
  double high = 1.0;
  std::vector<double> ticks;  ///< Inside [low, high].

  /// Place of a value: 0 at low, 1 at high. Values outside, also infinite ones, stand at the nearer end; NaN gives NaN.
  [[nodiscard]] double position(double value) const noexcept;
};

/// An axis from tick to tick around the finite values (the positive ones, where logarithmic; there, a value may stand
/// out by 0.1 %). Any values will do, also none.
[[nodiscard]] Axis nice_axis(std::string label, Scale scale, std::span<const double> values);

struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// A plot with axes, grid and legend. Points with a NaN are left out; points beyond an axis are drawn on its edge.
/// Series differ in colour and in the shape of their marks. `style` is the number of the series, from 0, and gives it
/// the same look in every plot. A series that was added earlier lies above those that were added later, and all of them
/// above regions and references.
class Plot {
 public:
  /// Width and height in px, at least 200 each.
  Plot(std::string title, Axis x, Axis y, double width, double height);

  /// A tinted region around a reference, without NaN. A legend line appears for names that are not empty, here and
  /// below.
  void region(std::string name, std::vector<Point> outline);
  /// A neutral line to compare with.
  void reference(std::string name, std::vector<Point> points);
  /// Marks joined by lines.
  void curve(std::string name, std::size_t style, std::vector<Point> points);
  /// A line with up to `marks` marks, evenly along the x axis: for curves of many points.
  void line(std::string name, std::size_t style, std::vector<Point> points, std::size_t marks = 0);
  /// Small dots.
  void cloud(std::string name, std::size_t style, std::vector<Point> points);
  /// Vertical lines from each of `from` to `to` at the same place, ending in a bar; all moved to the right by `shift`
  /// px.
  void whiskers(std::size_t style, std::vector<Point> from, std::vector<Point> to, double shift = 0.0);
  /// A number above the plot at `x`: of how many values the marks at this x are made.
  void count(double x, std::size_t values);
  /// Words to the right of a place; none where it is NaN.
  void label(Point place, std::string words);

  [[nodiscard]] Drawing drawing() const;

 private:
  enum class Kind { region, reference, curve, line, cloud, whiskers };
  struct Layer {
    Kind kind;
    std::string name;
    std::size_t style = 0;
    std::vector<Point> points;
    std::vector<Point> ends;
    double shift = 0.0;
    std::size_t marks = 0;
  };
  struct Count {
    double x;
    std::size_t values;
  };
  struct Label {
    Point place;
    std::string words;
  };
  class Painter;

  std::string title_;
  Axis x_;
  Axis y_;
  double width_;
  double height_;
  std::vector<Layer> layers_;
  std::vector<Count> counts_;
  std::vector<Label> labels_;
};

}  // namespace dermis::out::report
