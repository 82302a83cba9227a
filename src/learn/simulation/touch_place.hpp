// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::simulation {

/// Where a touch is: on one taxel alone, or soft: forces fall off as a Gaussian around a place, in units of taxels.
struct TouchPlace {
  std::optional<std::size_t> taxel{};
  double row = 0.0;
  double col = 0.0;
  double sigma_pitches = 1.0;
};

/// Anywhere on the array, on one taxel in 40 of 100 cases.
[[nodiscard]] TouchPlace draw_place(const ArrayDescription& array, Random& random);

/// Adds a touch of `peak_n` at its centre to the forces [N], [rows, cols]; of a soft one, shares below 0.02 N are cut
/// off.
void add_touch(const ArrayDescription& array, const TouchPlace& place, double peak_n, std::vector<double>& force_n);

}  // namespace dermis::learn::simulation
