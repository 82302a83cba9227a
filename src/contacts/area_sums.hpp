// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>

#include "contacts/taxel_plane.hpp"
#include "dermis/core/contacts.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::contacts {

/// What sums over the taxels of a stressed area tell about its contact: force, centre of the forces, area, pressures
/// and axes. Of the result id, phase, onset and velocity are left. `taxels` by falling force, at least one.
[[nodiscard]] Contact sum_up(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels);

/// Each taxel weighs the root of its force times its signal. Of the forces alone, one that hardly stands out of the
/// noise at the rim weighs what its law makes of that noise, which comes and goes; of the signals alone, what unlike
/// taxels differ by. Saturated taxels have no signal: there it is `of_forces`, the centre of the forces.
[[nodiscard]] PlaneVector centre_of_mass(const TaxelPlane& plane, const ForceFrame& force,
                                         std::span<const std::uint32_t> taxels, PlaneVector of_forces);

}  // namespace dermis::contacts
