// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "compensation/faults/line_sums.hpp"
#include "compensation/faults/unloaded_taxels.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::compensation {

/// One frame, as the detectors see it.
struct Observation {
  const ConditionedFrame& conditioned;
  const ConductanceFrame& conductance;
  const LineSums& sums;
  const UnloadedTaxels& unloaded;
  std::size_t frame;  ///< Counted from 0.
  bool solved;        ///< The conductances are those of the circuit.
};

}  // namespace dermis::compensation
