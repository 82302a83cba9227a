// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/network_diagram.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "dermis/out/report/canvas.hpp"

namespace dermis::paper {

using out::report::Anchor;
using out::report::Canvas;
using out::report::Drawing;
using out::report::line_to;
using out::report::move_to;
using out::report::Point;
using out::report::series_class;

namespace {

constexpr double kWidth = 480.0;
constexpr double kTop = 30.0;
constexpr double kStep = 46.0;    // From unit to unit of a layer [px].
constexpr double kMargin = 64.0;  // From the edge to the middle of the outer layers.
constexpr double kRadius = 15.0;
constexpr double kBottom = 44.0;

class Painter {
 public:
  explicit Painter(const NetworkDiagram& diagram) : diagram_(diagram) {
    for (const auto& layer : diagram.layers) most_units_ = std::max(most_units_, layer.units.size());
    height_ = kStep * static_cast<double>(most_units_);
  }

  Drawing paint() && {
    canvas_.text("title", Anchor::start, {20.0, 16.0}, diagram_.title);
    for (std::size_t layer = 1; layer < diagram_.layers.size(); ++layer) draw_links(layer);
    for (std::size_t layer = 0; layer < diagram_.layers.size(); ++layer) draw_layer(layer);
    draw_output();
    return {kWidth, kTop + height_ + kBottom, diagram_.title + ": diagram of a network", std::move(canvas_).take()};
  }

 private:
  [[nodiscard]] const std::vector<std::string>& units(std::size_t layer) const { return diagram_.layers[layer].units; }

  [[nodiscard]] Point place(std::size_t layer, std::size_t unit) const {
    const double step = (kWidth - 2.0 * kMargin) / static_cast<double>(diagram_.layers.size() - 1);
    const double above = static_cast<double>(unit) + 0.5 - static_cast<double>(units(layer).size()) / 2.0;
    return {kMargin + step * static_cast<double>(layer), kTop + height_ / 2.0 + kStep * above};
  }

  void draw_links(std::size_t layer) {
    std::string links;
    std::string own;
    const bool has_own = diagram_.shows_own && units(layer).size() == units(layer - 1).size();
    for (std::size_t from = 0; from < units(layer - 1).size(); ++from) {
      for (std::size_t to = 0; to < units(layer).size(); ++to) {
        if (units(layer - 1)[from].empty() || units(layer)[to].empty()) continue;
        (has_own && from == to ? own : links) += move_to(place(layer - 1, from)) + line_to(place(layer, to));
      }
    }
    canvas_.path("link", links);
    if (own.empty()) return;
    canvas_.open_group(series_class(0));
    canvas_.path("own", own);
    canvas_.close_group();
  }

  void draw_layer(std::size_t layer) {
    for (std::size_t unit = 0; unit < units(layer).size(); ++unit) draw_unit(layer, unit);
    const double x = place(layer, 0).x;
    canvas_.text("small", Anchor::middle, {x, kTop + height_ + 16.0}, diagram_.layers[layer].name);
    canvas_.text("small muted", Anchor::middle, {x, kTop + height_ + 31.0}, diagram_.layers[layer].remark);
  }

  void draw_unit(std::size_t layer, std::size_t unit) {
    const Point at = place(layer, unit);
    const std::string& words = units(layer)[unit];
    if (words.empty()) {
      for (const double shift : {-8.0, 0.0, 8.0}) canvas_.path("dots", move_to({at.x, at.y + shift}) + "h0");
      return;
    }
    if (layer == 0) {
      canvas_.rectangle("unit", {at.x - kRadius, at.y - kRadius}, 2.0 * kRadius, 2.0 * kRadius);
    } else {
      canvas_.path("unit", move_to({at.x - kRadius, at.y}) + "a15 15 0 1 0 30 0a15 15 0 1 0-30 0z");
    }
    canvas_.text("small", Anchor::middle, {at.x, at.y + 4.0}, words);
  }

  void draw_output() {
    const std::size_t last = diagram_.layers.size() - 1;
    for (std::size_t unit = 0; unit < units(last).size(); ++unit) {
      const Point at = place(last, unit);
      const Point tip{at.x + kRadius + 26.0, at.y};
      canvas_.path("frame", move_to({at.x + kRadius, at.y}) + line_to(tip) + move_to({tip.x - 6.0, tip.y - 4.0}) +
                                line_to(tip) + line_to({tip.x - 6.0, tip.y + 4.0}));
    }
  }

  const NetworkDiagram& diagram_;
  Canvas canvas_;
  std::size_t most_units_ = 1;
  double height_ = 0.0;
};

}  // namespace

Drawing network_diagram(const NetworkDiagram& diagram) {
  assert(diagram.layers.size() >= 2);
  return Painter(diagram).paint();
}

}  // namespace dermis::paper
