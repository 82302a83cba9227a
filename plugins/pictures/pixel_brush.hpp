// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cairo.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "out/report/brush.hpp"

namespace dermis::out::report {

/// Paints pixels, two a length, by cairo. Texts have the sans-serif face of the machine.
class PixelBrush final : public Brush {
 public:
  PixelBrush(double width, double height);

  void fill(Point corner, double width, double height, Colour colour) override;
  void lines(const std::vector<std::vector<Point>>& lines, double width, Colour colour) override;
  void text(Anchor anchor, Point place, double size, Colour colour, const std::string& words) override;
  void label(Point centre, double size, const std::string& words) override;

  /// The bytes of a PNG file.
  [[nodiscard]] std::string png() const;
  [[nodiscard]] std::size_t width() const;
  [[nodiscard]] std::size_t height() const;
  /// A line of pixels, each red, green and blue from bit 16 down.
  [[nodiscard]] std::span<const std::uint32_t> line(std::size_t y) const;

 private:
  struct Free {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };

  /// Takes the path that is open.
  void stroke(double width, Colour colour);
  void set_colour(Colour colour);
  /// The path of a text whose middle, start or end is at the place.
  void open_text(Anchor anchor, Point place, double size, const std::string& words);

  std::unique_ptr<cairo_surface_t, Free> surface_;
  std::unique_ptr<cairo_t, Free> context_;
};

}  // namespace dermis::out::report
