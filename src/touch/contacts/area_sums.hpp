// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>

#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "touch/contacts/taxel_plane.hpp"

namespace dermis::touch::contacts {

/// Describes a contact by sums over the taxels of its stressed area: force, centre of the forces, area, pressures and
/// axes. The result lacks id, phase, onset and velocity. `taxels` by falling force, at least one.
[[nodiscard]] Contact sum_up(const TaxelPlane& plane, const ForceFrame& force, std::span<const std::uint32_t> taxels);

/// Each taxel weighs the root of its force times its signal. By force alone, a taxel at the rim near the noise would
/// weigh as its law magnifies that noise, which comes and goes. By signal alone, the differences between taxels would
/// count. Saturated taxels have no signal: there it is `of_forces`, the centre of the forces.
[[nodiscard]] PlaneVector centre_of_mass(const TaxelPlane& plane, const ForceFrame& force,
                                         std::span<const std::uint32_t> taxels, PlaneVector of_forces);

}  // namespace dermis::touch::contacts
