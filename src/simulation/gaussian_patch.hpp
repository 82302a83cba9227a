// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/random.hpp"

namespace dermis::simulation {

/// A soft contact: forces fall off as a Gaussian around a place, in units of taxels.
struct GaussianPatch {
  double row = 0.0;
  double col = 0.0;
  double sigma_pitches = 1.0;
};

/// Centred anywhere on the array, as wide as the scene "multitouch" says.
[[nodiscard]] GaussianPatch draw_patch(const ArrayDescription& array, Random& random);

/// Adds a patch of `peak_n` at its centre to the forces [N], [rows, cols]; what is below 0.02 N is cut off.
void add_patch(const ArrayDescription& array, const GaussianPatch& patch, double peak_n, std::vector<double>& force_n);

}  // namespace dermis::simulation
