// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>

namespace dermis::out::report {
namespace {

constexpr double kCharacterWidth = 6.2;  // Mean of a sans-serif face at 11 px.

constexpr std::array<const char*, 3> kAnchorClasses = {"", " middle", " end"};

}  // namespace

void Canvas::line(std::string_view style, Point from, Point to) {
  fmt::format_to(std::back_inserter(elements_), "<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>\n", style,
                 coordinate(from.x), coordinate(from.y), coordinate(to.x), coordinate(to.y));
}

void Canvas::rectangle(std::string_view style, Point corner, double width, double height) {
  fmt::format_to(std::back_inserter(elements_), "<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                 style, coordinate(corner.x), coordinate(corner.y), coordinate(width), coordinate(height));
}

void Canvas::path(std::string_view style, std::string_view data) {
  if (data.empty()) return;
  fmt::format_to(std::back_inserter(elements_), "<path class=\"{}\" d=\"{}\"/>\n", style, data);
}

void Canvas::filled_path(std::string_view style, std::string_view colour, std::string_view data) {
  fmt::format_to(std::back_inserter(elements_), "<path class=\"{}\" fill=\"{}\" d=\"{}\"/>\n", style, colour, data);
}

void Canvas::text(std::string_view style, Anchor anchor, Point place, std::string_view words) {
  fmt::format_to(std::back_inserter(elements_), "<text class=\"{}{}\" x=\"{}\" y=\"{}\">{}</text>\n", style,
                 kAnchorClasses[static_cast<std::size_t>(anchor)], coordinate(place.x), coordinate(place.y),
                 escape_xml(words));
}

void Canvas::upright_text(std::string_view style, Point centre, std::string_view words) {
  fmt::format_to(std::back_inserter(elements_),
                 "<text class=\"{} middle\" transform=\"translate({} {}) rotate(-90)\">{}</text>\n", style,
                 coordinate(centre.x), coordinate(centre.y), escape_xml(words));
}

void Canvas::open_group(std::string_view style) {
  fmt::format_to(std::back_inserter(elements_), "<g class=\"{}\">\n", style);
}

void Canvas::close_group() {
  elements_ += "</g>\n";
}

std::string coordinate(double value) {
  assert(std::isfinite(value));
  return fmt::format("{:.8g}", std::round(value * 100.0) / 100.0 + 0.0);
}

std::string move_to(Point point) {
  return "M" + coordinate(point.x) + " " + coordinate(point.y);
}

std::string line_to(Point point) {
  return "L" + coordinate(point.x) + " " + coordinate(point.y);
}

std::string mark(std::size_t style, Point centre) {
  static constexpr std::array<const char*, 6> kShapes = {
      "m-3.6 0a3.6 3.6 0 1 0 7.2 0a3.6 3.6 0 1 0-7.2 0z",           // circle
      "m-3.3-3.3h6.6v6.6h-6.6z",                                    // square
      "m0-4.2l4.1 7.2h-8.2z",                                       // triangle
      "m0-4.5l4 4.5l-4 4.5l-4-4.5z",                                // diamond
      "m0 4.2l4.1-7.2h-8.2z",                                       // triangle, point down
      "m-4-1.2h2.8v-2.8h2.4v2.8h2.8v2.4h-2.8v2.8h-2.4v-2.8h-2.8z",  // plus
  };
  return move_to(centre) + kShapes[style % kShapes.size()];
}

std::string series_class(std::size_t style) {
  constexpr std::size_t kColours = 7;  // Seven colours and six marks: 42 looks.
  return "s" + std::to_string(style % kColours);
}

double text_width(std::string_view words) {
  const auto starts_character = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; };
  return kCharacterWidth * static_cast<double>(std::count_if(words.begin(), words.end(), starts_character));
}

std::string tick_label(double value) {
  return fmt::format("{:.6g}", value);
}

}  // namespace dermis::out::report
