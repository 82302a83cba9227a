// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "command_line.hpp"
#include "dermis/live/forces/force_tables.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// An evaluation of calibrations on what each has not seen.
struct LeftOutEvaluation {
  std::string leave_out;  ///< "press"; empty: of a model.
  std::string array;
  live::forces::ForceTablePaths tables;
};

/// Declares --leave-out, --array, --out, --totals and --contacts; `evaluation` must live as long as the action.
void add_left_out_evaluation(Command& command, LeftOutEvaluation& evaluation);

/// Calibrates without each press of the recording in turn, and prints the errors on it.
[[nodiscard]] Status evaluate_left_out(const LeftOutEvaluation& evaluation, const std::string& frames,
                                       const std::string& loads, bool json);

}  // namespace dermis::app
