// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/touch.hpp"
#include "touch/compensation/faults/line_sums.hpp"
#include "touch/compensation/faults/unloaded_taxels.hpp"
#include "touch/compensation/faults/unloaded_witnesses.hpp"

namespace dermis::touch::compensation {

inline constexpr double kPressedSigmas = 20.0;  // of a reading that is surely not noise

/// One frame, as the detectors see it.
struct Observation {
  const ConditionedFrame& conditioned;
  const ConductanceFrame& conductance;
  const LineSums& sums;
  const UnloadedTaxels& unloaded;
  const UnloadedWitnesses& witnesses;
  std::size_t frame;  ///< Counted from 0.
  bool solved;        ///< The conductances are those of the circuit.

  /// The reading is surely more than an unloaded taxel's.
  [[nodiscard]] bool is_pressed(std::size_t taxel) const noexcept {
    return conditioned.ratio[taxel] > touched_above(unloaded.ratio()[taxel], conditioned.sigma_ratio, kPressedSigmas);
  }

  /// The taxel's own conductance is surely more. The reading does not suffice where rows float: there a press shows on
  /// all rows.
  [[nodiscard]] bool conducts_more(std::size_t taxel) const noexcept {
    return solved && conductance.siemens[taxel] > unloaded.most_siemens(taxel, conductance.sigma_siemens[taxel]);
  }
};

}  // namespace dermis::touch::compensation
