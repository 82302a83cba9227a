// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// A point of a table y(x), the mean of `weight` points.
struct Knot {
  double x = 0.0;
  double y = 0.0;
  double weight = 1.0;
};

/// `knots` by rising x: at most `most` of them, by merging equal numbers of neighbours.
void thin_out(std::vector<Knot>& knots, std::size_t most);

/// `knots` by rising x: pools those that are less than `least_step` apart, so that the table has a slope everywhere.
void merge_equal(std::vector<Knot>& knots, double least_step);

/// `knots` by rising x: pools neighbours until y rises with x (Ayer et al. 1955).
void pool_adjacent_violators(std::vector<Knot>& knots);

/// `knots` by rising x and y: pools neighbours until both rise where they are rounded to single precision.
void pool_equal_floats(std::vector<Knot>& knots);

}  // namespace dermis::learn::calibration
