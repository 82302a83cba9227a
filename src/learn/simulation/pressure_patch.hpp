// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/simulation/scene.hpp"

namespace dermis::learn::simulation {

/// Force that a round patch puts on a round taxel whose centre is `distance_m` away [N]. It is the integral of the
/// pressure over their common area, to 1e-4 of the patch's force.
[[nodiscard]] double force_on_disc(PatchShape shape, double force_n, double patch_radius_m, double disc_radius_m,
                                   double distance_m);

}  // namespace dermis::learn::simulation
