// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>

namespace dermis::out::report {

/// The palette of every map, also in the browser (viewer/src/render/color_map.ts, held equal by a test). The
/// coefficients are those of place^0, place^1, ... for red, green and blue in sRGB, in [0, 1]. Fitted to even steps in
/// Oklab.
constexpr std::array<std::array<double, 3>, 7> kPalette = {{{0.0479, 0.0528, 0.1676},
                                                            {0.4204, 0.5649, 1.3116},
                                                            {6.8652, -0.6374, 4.4242},
                                                            {-18.8601, -4.9426, -30.1666},
                                                            {28.3001, 20.3941, 50.8979},
                                                            {-24.5515, -22.1484, -35.9475},
                                                            {8.755, 7.6851, 9.9848}}};

/// The first percent of a scale has a tenth of the colours: what barely presses differs from nothing. There they rise
/// by the cube of the share, so that noise looks like nothing.
constexpr double kToeShare = 0.01;
constexpr double kToeColours = 0.1;

}  // namespace dermis::out::report
