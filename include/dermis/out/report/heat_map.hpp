// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/svg.hpp"

namespace dermis::out::report {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

/// A sequential colour map, from ink over red to pale yellow: the palette of the viewer. It suits readers with any
/// colour vision and grey prints. `share` is clamped to [0, 1]; not NaN. Lightness rises in even steps (Oklab, B.
/// Ottosson, "A perceptual color space for image processing", 2020). The first percent has a tenth of them, so that it
/// differs from 0.
[[nodiscard]] Colour sequential_colour(double share) noexcept;

/// A diverging colour map for signed quantities: dark blue over near white at 0 to dark orange. `share` is clamped to
/// [-1, 1]; not NaN. Both arms darken linearly and alike (Oklab L from 0.965 to 0.39), so a grey print shows the
/// magnitude. Blue (hue 260 degrees) and orange (45) show the sign to readers with any colour vision.
[[nodiscard]] Colour diverging_colour(double share) noexcept;

/// "#0d62ac"
[[nodiscard]] std::string to_hex(Colour colour);

enum class Colours : std::uint8_t {
  sequential,  ///< From 0 to `high`.
  diverging,   ///< From -`high` to `high`.
};

/// Axes of a function of two variables; each cell is centred on its sample.
struct MapAxes {
  Axis x;  ///< Along the columns.
  Axis y;  ///< Along the rows; row 0 is at the bottom.
};

/// One quantity on every taxel of an array: each measured taxel is a square, nothing is interpolated.
struct HeatMap {
  std::string title;       ///< With the unit of the colour scale: "force [N]".
  std::size_t rows = 0;    ///< >= 1
  std::size_t cols = 0;    ///< >= 1
  double row_pitch = 1.0;  ///< Distance of rows over distance of columns is the shape of a taxel; > 0.
  double col_pitch = 1.0;
  double high = 1.0;           ///< End of the colour scale; finite and > 0.
  std::vector<double> values;  ///< [rows, cols]; NaN and infinity are drawn as crossed-out squares.
  Colours colours = Colours::sequential;
  std::optional<MapAxes> axes = std::nullopt;  ///< Instead of the names of the array's lines.
};

[[nodiscard]] Drawing heat_map(const HeatMap& map);

/// End of a colour scale for these values: their largest finite one, or 1 where none is above 0.
[[nodiscard]] double heat_map_high(const std::vector<double>& values) noexcept;

}  // namespace dermis::out::report
