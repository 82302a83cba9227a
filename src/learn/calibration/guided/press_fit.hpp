// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "learn/calibration/guided/held_out_presses.hpp"

namespace dermis::learn::calibration {

/// The presses of a guided calibration that are to be fitted.
struct FitJob {
  std::shared_ptr<const std::vector<RawFrame>> unloaded;
  GuidedPresses presses;
  bool is_last = false;  ///< The model is wanted, too.
};

struct FitOutcome {
  std::optional<double> error;                     ///< On presses that were left out.
  std::optional<double> unpressed_error;           ///< On taxels that were left out; of a last job.
  std::optional<Result<Calibration>> calibration;  ///< Of a last job.
};

/// `progress` gets the share done of a last job, from any thread. Deterministic, thread-safe.
[[nodiscard]] FitOutcome fit_presses(const ArrayDescription& array, const FitJob& job,
                                     const std::function<void(double)>& progress);

}  // namespace dermis::learn::calibration
