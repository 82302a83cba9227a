// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "dermis/core/array_description.hpp"

namespace dermis::calibration {

/// The noise of a reading as a share of a taxel's conductance, where most taxels are pressed in all frames with a load:
/// idle lines that float tie all others to one potential then, and a reading hardly depends on its own taxel. In the
/// frame where that is least. Changes of conductance that leave the sums of all lines as they are stand for all. 0:
/// there are frames with fewer pressed taxels, which any circuit resolves. Unknown drivers are taken to be ideal,
/// unknown loads to be alike.
[[nodiscard]] double noise_share(const ArrayDescription& array, const CircuitFrames& frames);

/// noise_share() where it is too much for the conductances to be found, 0 where they can be; also without a circuit.
[[nodiscard]] double unresolved_share(const ArrayDescription& array, const CircuitFrames& frames);

}  // namespace dermis::calibration
