// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// The loads that taxels feel of those on the cover of `array`, which is known; without a cover the loads themselves.
/// Loads of single taxels, and pressures, become a force for each taxel that feels them. A force over several taxels
/// becomes one over all that may feel it.
[[nodiscard]] std::vector<Load> felt_loads(const ArrayDescription& array, std::span<const Load> loads);

/// The same for learning. A force is not known (NaN) where it is fainter than any that stood above its taxel, or a
/// small share of its frame's.
[[nodiscard]] std::vector<Load> well_felt_loads(const ArrayDescription& array, std::span<const Load> loads);

/// The same with all loads of a frame in one, over all taxels that may feel them.
[[nodiscard]] std::vector<Load> felt_totals(const ArrayDescription& array, std::span<const Load> loads);

}  // namespace dermis::learn::calibration
