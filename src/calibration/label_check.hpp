// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/loads.hpp"

namespace dermis::calibration {

/// Labels that people wrote, held against the readings: the sum of all taxels rises with the load, whatever the
/// circuit.
struct LabelCheck {
  std::vector<Load> loads;           ///< Without those of frames that are called unloaded but are pressed.
  std::vector<std::string> remarks;  ///< What is wrong with the labels, a sentence each.
};

/// `loads` as check_loads() wants them.
[[nodiscard]] LabelCheck check_labels(const ArrayDescription& array, std::span<const RawFrame> frames,
                                      std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::calibration
