// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/learn/calibration/calibration_plan.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// The request of /calibration/start (docs/stream.md). Values that are not asked for are those of default_plan().
struct PlanRequest {
  std::string array;  ///< Empty: not given.
  std::optional<std::vector<double>> weights_n;
  std::optional<std::vector<std::size_t>> taxels;
  std::optional<std::size_t> stride;  ///< 1 where all taxels are asked for.
  std::optional<double> unloaded_s;
  std::optional<double> hold_s;

  /// Errors: those of CalibrationPlan::validate().
  [[nodiscard]] Result<CalibrationPlan> plan(const ArrayDescription& array) const;
};

/// Reads at most 256 KiB of JSON. Errors name the field: unknown ones, too, with the nearest known name.
[[nodiscard]] Result<PlanRequest> plan_request_from_json(std::string_view json);

}  // namespace dermis::learn::calibration
