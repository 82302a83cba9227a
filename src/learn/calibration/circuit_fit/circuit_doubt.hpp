// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// Another circuit, other resistances or another ADC than what is described.
struct CircuitDoubt {
  std::string sentence;
  ArrayDescription array;  ///< With the circuit that explains the frames best.
};

/// Not empty where another circuit, other resistances or another ADC explain the frames surely better than what the
/// description says. The search runs only where idle taxels on pressed lines have readings that the described circuit
/// does not explain. Empty: there is none, or the kind of the circuit is not given.
[[nodiscard]] std::optional<CircuitDoubt> doubt_circuit(const ArrayDescription& array, const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
