// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/svg.hpp"

namespace dermis::paper {

/// A signed function of two variables as a surface in space. The view is that of MATLAB's mesh(): azimuth -37.5 and
/// elevation 30 degrees, in parallel projection. Colours are those of diverging_colour() over the height.
struct Surface {
  std::string title;
  out::report::Axis x;  ///< Linear axes; the samples are spread evenly over x and y.
  out::report::Axis y;
  out::report::Axis z;
  std::size_t rows = 2;        ///< >= 2, along y.
  std::size_t cols = 2;        ///< >= 2, along x.
  std::vector<double> values;  ///< [rows, cols]; facets with a corner that is not finite are left out.
};

[[nodiscard]] out::report::Drawing surface(const Surface& surface);

}  // namespace dermis::paper
