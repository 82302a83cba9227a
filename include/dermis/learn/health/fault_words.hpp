// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// A fault and the frames in which it was present.
struct FaultHistory {
  touch::compensation::LineFault fault;  ///< As it was last seen.
  std::optional<std::size_t> until{};    ///< First frame without it; empty while it lasts.
  std::size_t times = 1;  ///< It was found so often, first in fault.frame and gone the last time at `until`.
};

/// Describes a fault, to be read after place_name(): its kind, since when, what to check, and what is lost. "is open
/// since frame 120: check the wire or crimp of row 3; its 16 taxels are masked, the rest is still good".
[[nodiscard]] std::string describe(const FaultHistory& history, const ArrayDescription& array);

/// Short state of a working array at this moment.
struct Condition {
  /// "healthy", "dead taxels" (since calibration), "recalibrate: gains have changed by about 9 %" or "2 faults".
  std::string message;
  /// Each fault by its place_name() with its describe(). Then the names of the taxels that are dead since calibration,
  /// and the state of "gains".
  std::vector<std::pair<std::string, std::string>> details;
};

/// `faults`: those that stand.
[[nodiscard]] Condition condition_of(const touch::pipeline::Model& model,
                                     std::span<const touch::compensation::LineFault> faults,
                                     const AgeingEvidence& ageing = {});

}  // namespace dermis::learn::health
