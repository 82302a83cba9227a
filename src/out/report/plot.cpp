// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/out/report/canvas.hpp"

namespace dermis::out::report {
namespace {

constexpr double kTitleHeight = 24.0;
constexpr double kLegendRow = 17.0;
constexpr double kLegendKey = 24.0;
constexpr double kLegendGap = 16.0;
constexpr double kCountsHeight = 16.0;
constexpr double kRightMargin = 16.0;
constexpr double kXLabels = 42.0;
constexpr double kTickLength = 4.0;
constexpr double kCap = 3.0;  // Half the bar at the end of a whisker.

double widest_label(const Axis& axis) {
  double widest = 0.0;
  for (const double tick : axis.ticks) widest = std::max(widest, text_width(tick_label(tick)));
  return widest;
}

}  // namespace

/// Lays a plot out and draws it from back to front.
class Plot::Painter {
 public:
  explicit Painter(const Plot& plot) : plot_(plot) {
    place_legend();
    const double counts = plot.counts_.empty() ? 0.0 : kCountsHeight;
    left_ = 30.0 + widest_label(plot.y_);
    right_ = plot.width_ - kRightMargin;
    top_ = kTitleHeight + legend_height_ + counts + 8.0;
    bottom_ = plot.height_ - kXLabels;
  }

  std::string paint() && {
    canvas_.text("title", Anchor::start, {left_, 16.0}, plot_.title_);
    for (std::size_t i = 0; i < entries_.size(); ++i) draw_entry(entries_[i]);
    draw_counts();
    draw_x_axis();
    draw_y_axis();
    for (const Layer& layer : plot_.layers_) draw_backdrop(layer);
    std::for_each(plot_.layers_.rbegin(), plot_.layers_.rend(), [this](const Layer& layer) { draw_series(layer); });
    canvas_.rectangle("frame", {left_, top_}, right_ - left_, bottom_ - top_);
    for (const Label& label : plot_.labels_) {
      canvas_.text("small", Anchor::start, {to_x(label.place.x) + 6.0, to_y(label.place.y) + 4.0}, label.words);
    }
    return std::move(canvas_).take();
  }

 private:
  struct Entry {
    const Layer* layer;
    Point place;
  };

  void place_legend() {
    const double left = 30.0 + widest_label(plot_.y_);
    Point place{left, kTitleHeight + 10.0};
    for (const Layer& layer : plot_.layers_) {
      if (layer.name.empty()) continue;
      const double width = kLegendKey + text_width(layer.name);
      if (place.x > left && place.x + width > plot_.width_) place = {left, place.y + kLegendRow};
      entries_.push_back({&layer, place});
      place.x += width + kLegendGap;
    }
    if (!entries_.empty()) legend_height_ = place.y - kTitleHeight + 4.0;
  }

  void draw_entry(const Entry& entry) {
    const Point from{entry.place.x, entry.place.y - 4.0};
    const Point to{from.x + 18.0, from.y};
    const Point middle{from.x + 9.0, from.y};
    switch (entry.layer->kind) {
      case Kind::region: canvas_.rectangle("region", {from.x, from.y - 5.0}, 18.0, 10.0); break;
      case Kind::reference: canvas_.line("reference", from, to); break;
      case Kind::curve:
      case Kind::line:
      case Kind::cloud:
      case Kind::whiskers:
        canvas_.open_group(series_class(entry.layer->style));
        if (entry.layer->kind == Kind::curve || entry.layer->kind == Kind::line) canvas_.line("curve", from, to);
        if (entry.layer->kind != Kind::line || entry.layer->marks > 0) {
          canvas_.path("mark", mark(entry.layer->style, middle));
        }
        canvas_.close_group();
        break;
    }
    canvas_.text("small", Anchor::start, {from.x + kLegendKey, entry.place.y}, entry.layer->name);
  }

  void draw_counts() {
    if (plot_.counts_.empty()) return;
    const double y = top_ - 6.0;
    canvas_.text("small muted", Anchor::end, {left_ - 8.0, y}, "n =");
    double free_from = left_ - 8.0;
    for (const Count& count : plot_.counts_) {
      const std::string words = std::to_string(count.values);
      const double x = to_x(count.x);
      const double half = text_width(words) / 2.0;
      if (x - half < free_from) continue;
      canvas_.text("small muted", Anchor::middle, {x, y}, words);
      free_from = x + half + 4.0;
    }
  }

  void draw_x_axis() {
    double free_from = -std::numeric_limits<double>::infinity();
    for (const double tick : plot_.x_.ticks) {
      const double x = to_x(tick);
      if (x > left_ && x < right_) canvas_.line("grid", {x, top_}, {x, bottom_});
      canvas_.line("tick", {x, bottom_}, {x, bottom_ + kTickLength});
      const double half = text_width(tick_label(tick)) / 2.0;
      if (x - half < free_from) continue;
      const double middle = std::min(x, plot_.width_ - half - 4.0);
      canvas_.text("small", Anchor::middle, {middle, bottom_ + 17.0}, tick_label(tick));
      free_from = x + half + 2.0;
    }
    canvas_.text("muted", Anchor::middle, {(left_ + right_) / 2.0, bottom_ + 35.0}, plot_.x_.label);
  }

  void draw_y_axis() {
    for (const double tick : plot_.y_.ticks) {
      const double y = to_y(tick);
      if (y > top_ && y < bottom_) canvas_.line("grid", {left_, y}, {right_, y});
      canvas_.line("tick", {left_ - kTickLength, y}, {left_, y});
      canvas_.text("small", Anchor::end, {left_ - kTickLength - 3.0, y + 4.0}, tick_label(tick));
    }
    canvas_.upright_text("muted", {13.0, (top_ + bottom_) / 2.0}, plot_.y_.label);
  }

  void draw_backdrop(const Layer& layer) {
    if (layer.kind == Kind::region) canvas_.path("region", joined(layer) + "z");
    if (layer.kind == Kind::reference) canvas_.path("reference", joined(layer));
  }

  void draw_series(const Layer& layer) {
    if (layer.kind == Kind::region || layer.kind == Kind::reference) return;
    canvas_.open_group(series_class(layer.style));
    if (layer.kind == Kind::curve) {
      canvas_.path("curve", joined(layer));
      canvas_.path("mark", marks(layer));
    } else if (layer.kind == Kind::line) {
      canvas_.path("curve", joined(layer));
      canvas_.path("mark", few_marks(layer));
    } else if (layer.kind == Kind::cloud) {
      canvas_.path("cloud", dots(layer));
    } else {
      canvas_.path("whisker", whiskers(layer));
    }
    canvas_.close_group();
  }

  /// A line through the points; it breaks where one is missing.
  std::string joined(const Layer& layer) const {
    std::string data;
    bool is_first = true;
    for (const Point& point : layer.points) {
      const bool is_missing = std::isnan(point.x) || std::isnan(point.y);
      if (!is_missing) data += is_first ? move_to(place(layer, point)) : line_to(place(layer, point));
      is_first = is_missing;
    }
    return data;
  }

  std::string marks(const Layer& layer) const {
    std::string data;
    for (const Point& point : layer.points) {
      if (!std::isnan(point.x) && !std::isnan(point.y)) data += mark(layer.style, place(layer, point));
    }
    return data;
  }

  /// On points that are at least 1 / marks of the x axis apart.
  std::string few_marks(const Layer& layer) const {
    std::string data;
    double next = -1.0;
    for (const Point& point : layer.points) {
      if (layer.marks == 0 || std::isnan(point.x) || std::isnan(point.y)) continue;
      const double position = plot_.x_.position(point.x);
      if (position < next) continue;
      data += mark(layer.style, place(layer, point));
      next = position + 1.0 / static_cast<double>(layer.marks);
    }
    return data;
  }

  std::string dots(const Layer& layer) const {
    std::string data;
    for (const Point& point : layer.points) {
      if (!std::isnan(point.x) && !std::isnan(point.y)) data += move_to(place(layer, point)) + "h0";
    }
    return data;
  }

  std::string whiskers(const Layer& layer) const {
    std::string data;
    for (std::size_t i = 0; i < layer.points.size(); ++i) {
      if (std::isnan(layer.points[i].x) || std::isnan(layer.points[i].y) || std::isnan(layer.ends[i].y)) continue;
      const Point from = place(layer, layer.points[i]);
      const Point to{from.x, to_y(layer.ends[i].y)};
      data += move_to(from) + line_to(to) + move_to({to.x - kCap, to.y}) + line_to({to.x + kCap, to.y});
    }
    return data;
  }

  double to_x(double value) const { return left_ + plot_.x_.position(value) * (right_ - left_); }
  double to_y(double value) const { return bottom_ - plot_.y_.position(value) * (bottom_ - top_); }
  Point place(const Layer& layer, Point point) const { return {to_x(point.x) + layer.shift, to_y(point.y)}; }

  const Plot& plot_;
  Canvas canvas_;
  std::vector<Entry> entries_;
  double legend_height_ = 0.0;
  double left_ = 0.0;
  double right_ = 0.0;
  double top_ = 0.0;
  double bottom_ = 0.0;
};

Plot::Plot(std::string title, Axis x, Axis y, double width, double height)
    : title_(std::move(title)), x_(std::move(x)), y_(std::move(y)), width_(width), height_(height) {
  assert(width >= 200.0 && height >= 200.0);
}

void Plot::region(std::string name, std::vector<Point> outline) {
  layers_.push_back({Kind::region, std::move(name), 0, std::move(outline), {}, 0.0});
}

void Plot::reference(std::string name, std::vector<Point> points) {
  layers_.push_back({Kind::reference, std::move(name), 0, std::move(points), {}, 0.0});
}

void Plot::curve(std::string name, std::size_t style, std::vector<Point> points) {
  layers_.push_back({Kind::curve, std::move(name), style, std::move(points), {}, 0.0});
}

void Plot::line(std::string name, std::size_t style, std::vector<Point> points, std::size_t marks) {
  layers_.push_back({Kind::line, std::move(name), style, std::move(points), {}, 0.0, marks});
}

void Plot::cloud(std::string name, std::size_t style, std::vector<Point> points) {
  layers_.push_back({Kind::cloud, std::move(name), style, std::move(points), {}, 0.0});
}

void Plot::whiskers(std::size_t style, std::vector<Point> from, std::vector<Point> to, double shift) {
  assert(from.size() == to.size());
  layers_.push_back({Kind::whiskers, "", style, std::move(from), std::move(to), shift});
}

void Plot::count(double x, std::size_t values) {
  if (!std::isnan(x)) counts_.push_back({x, values});
}

void Plot::label(Point place, std::string words) {
  if (!std::isnan(place.x) && !std::isnan(place.y)) labels_.push_back({place, std::move(words)});
}

Drawing Plot::drawing() const {
  const std::string description = fmt::format("{}: {} against {}", title_, y_.label, x_.label);
  return {width_, height_, description, Painter(*this).paint()};
}

}  // namespace dermis::out::report
