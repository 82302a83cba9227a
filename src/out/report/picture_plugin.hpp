// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dermis/out/report/heat_map.hpp"
#include "out/report/brush.hpp"

/// The work of the plugin that paints pixels, which is loaded with the first picture.
namespace dermis::out::report {

/// Pictures of one size.
struct Pictures {
  double width = 0.0;
  double height = 0.0;
  std::size_t count = 1;                                     ///< >= 1
  std::function<void(std::size_t picture, Brush&)> paint{};  ///< Texts are valid UTF-8.
};

/// Shows each picture for `time`, in whole hundredths of a second, for ever. Pixels have the nearest colour of 256.
struct Film {
  std::chrono::milliseconds time{};
  std::vector<Colour> palette;
};

/// Its functions give the bytes of a file.
struct PicturePlugin {
  std::string (*png)(const Pictures& first);
  std::string (*gif)(const Pictures& all, const Film& film);
};

/// The function of the plugin that finds them, and its name.
using FindPictures = void (*)(const PicturePlugin*& found);
inline constexpr const char* kFindPictures = "dermis_pictures";

}  // namespace dermis::out::report
