// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/bodies/free_places.hpp"
#include "dermis/out/report/svg.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::report {

/// One frame of an array as a picture. Each measured taxel has the colour of a fixed scale with its unit. r0c0 is at
/// the top left; taxels in no grid are at their places. Contacts are ellipses with their forces. Nothing is
/// interpolated.
struct FramePicture {
  std::string title;     ///< "chest"
  std::string subtitle;  ///< "12.340 s, total 23.4 N"
  std::size_t rows = 0;  ///< >= 1
  std::size_t cols = 0;  ///< >= 1
  double row_pitch_m = 0.010;
  double col_pitch_m = 0.010;
  std::vector<double> values;       ///< [rows, cols]; NaN and infinity are crossed out.
  double high = 1.0;                ///< End of the scale, which begins at 0; finite and > 0.
  std::string unit;                 ///< "N"
  std::vector<FreePlace> places{};  ///< Those of the taxels; empty: they are in their grid.
  std::vector<Contact> contacts;    ///< Those that have ended are not drawn.
};

/// 0 where none is finite.
[[nodiscard]] double largest_of(const std::vector<double>& values);

/// End of a colour scale that covers a value: 1, 2 or 5 times a power of ten newtons, at least 1.
[[nodiscard]] double force_scale(double newtons);

/// For svg_document().
[[nodiscard]] Drawing frame_drawing(const FramePicture& picture);

/// The bytes of a PNG file. Its texts have the sans-serif face of the machine. Fails where the plugin that paints, or
/// cairo, is not there.
[[nodiscard]] Result<std::string> frame_png(const FramePicture& picture);

/// The bytes of a GIF file that plays for ever. At least one picture, all of one shape and pitch; each is shown for
/// `time`, in whole hundredths of a second. Fails as frame_png() does.
[[nodiscard]] Result<std::string> frame_film(std::span<const FramePicture> pictures, std::chrono::milliseconds time);

}  // namespace dermis::out::report
