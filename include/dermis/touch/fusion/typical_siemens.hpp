// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/frames/film.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::touch::fusion {

/// The inverse of the networks at one force: the conductance of every taxel [S], > 0, under the force that is typical
/// for the array. That is the median of the taxels' forces at their reference conductances, at the middle of the
/// calibrated temperatures. A taxel without a force has the median conductance of the others, and 1 S where none has
/// one.
[[nodiscard]] std::vector<double> typical_siemens(const ForceNetworks& networks);

/// The one law of a sheet: the median force of all taxels where each conducts a share of its `typical` conductance.
/// Both are above the unloaded conductance, at the temperature of the unloaded law. Both members rise.
[[nodiscard]] std::vector<LoadPoint> load_points(const ForceNetworks& networks, std::span<const double> typical);

}  // namespace dermis::touch::fusion
