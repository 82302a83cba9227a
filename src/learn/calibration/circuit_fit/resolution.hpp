// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// The noise of a reading as a share of a taxel's conductance, where it is too large for the conductances to be found.
/// 0: they can be found, or there is no circuit.
[[nodiscard]] double unresolved_share(const ArrayDescription& array, const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
