// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "out/report/picture_plugin.hpp"
#include "pixel_brush.hpp"

struct GifFileType;

namespace dermis::out::report {

/// A film in the GIF format, encoded by giflib.
class Gif {
 public:
  /// All pictures have this size in pixels.
  Gif(std::size_t width, std::size_t height, const Film& film);
  Gif(const Gif&) = delete;
  Gif& operator=(const Gif&) = delete;
  ~Gif();

  void add(const PixelBrush& picture);
  /// The bytes of the file.
  [[nodiscard]] std::string take() &&;

 private:
  /// Place of the nearest colour of the palette.
  [[nodiscard]] std::uint8_t nearest(std::uint32_t pixel);

  std::string bytes_;
  std::vector<Colour> palette_;
  std::unordered_map<std::uint32_t, std::uint8_t> places_;  ///< Those that were found.
  int time_cs_;
  GifFileType* file_;
};

}  // namespace dermis::out::report
