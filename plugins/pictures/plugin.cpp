// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <optional>
#include <utility>

#include "gif.hpp"
#include "out/report/picture_plugin.hpp"
#include "pixel_brush.hpp"

/// The plugin that dermis::report loads.
namespace dermis::out::report {
namespace {

std::string png_of(const Pictures& pictures) {
  PixelBrush brush(pictures.width, pictures.height);
  pictures.paint(0, brush);
  return brush.png();
}

std::string gif_of(const Pictures& pictures, const Film& film) {
  std::optional<Gif> gif;
  for (std::size_t picture = 0; picture < pictures.count; ++picture) {
    PixelBrush brush(pictures.width, pictures.height);
    pictures.paint(picture, brush);
    if (!gif) gif.emplace(brush.width(), brush.height(), film);
    gif->add(brush);
  }
  return std::move(*gif).take();
}

constexpr PicturePlugin kPlugin{.png = png_of, .gif = gif_of};

}  // namespace
}  // namespace dermis::out::report

extern "C" __attribute__((visibility("default"))) void dermis_pictures(
    const dermis::out::report::PicturePlugin*& found) {
  found = &dermis::out::report::kPlugin;
}
