// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "pixel_brush.hpp"

#include <cassert>
#include <cmath>

namespace dermis::out::report {
namespace {

constexpr double kPixelsPerLength = 2.0;

int pixels(double length) {
  return static_cast<int>(std::ceil(kPixelsPerLength * length));
}

}  // namespace

PixelBrush::PixelBrush(double width, double height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height))),
      context_(cairo_create(surface_.get())) {
  cairo_scale(context_.get(), kPixelsPerLength, kPixelsPerLength);
  cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

/// Edges lie on whole pixels: neighbours touch without a seam.
void PixelBrush::fill(Point corner, double width, double height, Colour colour) {
  set_colour(colour);
  cairo_set_antialias(context_.get(), CAIRO_ANTIALIAS_NONE);
  cairo_rectangle(context_.get(), corner.x, corner.y, width, height);
  cairo_fill(context_.get());
  cairo_set_antialias(context_.get(), CAIRO_ANTIALIAS_DEFAULT);
}

void PixelBrush::lines(const std::vector<std::vector<Point>>& lines, double width, Colour colour) {
  for (const std::vector<Point>& line : lines) {
    cairo_new_sub_path(context_.get());
    for (const Point& point : line) cairo_line_to(context_.get(), point.x, point.y);
  }
  stroke(width, colour);
}

void PixelBrush::text(Anchor anchor, Point place, double size, Colour colour, const std::string& words) {
  open_text(anchor, place, size, words);
  set_colour(colour);
  cairo_fill(context_.get());
}

void PixelBrush::label(Point centre, double size, const std::string& words) {
  const Point place{centre.x, centre.y + 0.5 * size};
  open_text(Anchor::middle, place, size, words);
  stroke(kLabelEdge, kMarkEdge);
  text(Anchor::middle, place, size, kMark, words);
}

std::string PixelBrush::png() const {
  std::string file;
  const auto append = [](void* into, const unsigned char* bytes, unsigned size) {
    static_cast<std::string*>(into)->append(reinterpret_cast<const char*>(bytes), size);
    return CAIRO_STATUS_SUCCESS;
  };
  [[maybe_unused]] const cairo_status_t written = cairo_surface_write_to_png_stream(surface_.get(), append, &file);
  assert(written == CAIRO_STATUS_SUCCESS);
  return file;
}

std::size_t PixelBrush::width() const {
  return static_cast<std::size_t>(cairo_image_surface_get_width(surface_.get()));
}

std::size_t PixelBrush::height() const {
  return static_cast<std::size_t>(cairo_image_surface_get_height(surface_.get()));
}

std::span<const std::uint32_t> PixelBrush::line(std::size_t y) const {
  cairo_surface_flush(surface_.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()));
  const unsigned char* const first = cairo_image_surface_get_data(surface_.get()) + y * stride;
  return {reinterpret_cast<const std::uint32_t*>(first), width()};
}

void PixelBrush::stroke(double width, Colour colour) {
  set_colour(colour);
  cairo_set_line_width(context_.get(), width);
  cairo_stroke(context_.get());
}

void PixelBrush::set_colour(Colour colour) {
  cairo_set_source_rgb(context_.get(), colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

void PixelBrush::open_text(Anchor anchor, Point place, double size, const std::string& words) {
  cairo_set_font_size(context_.get(), font_size(size));
  cairo_text_extents_t extents{};
  cairo_text_extents(context_.get(), words.c_str(), &extents);
  const double share = anchor == Anchor::start ? 0.0 : anchor == Anchor::middle ? 0.5 : 1.0;
  cairo_move_to(context_.get(), place.x - share * extents.x_advance, place.y);
  cairo_text_path(context_.get(), words.c_str());
}

}  // namespace dermis::out::report
