// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "command_line.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// The files of an evaluation of forces, and how its result is shown.
struct ForceEvaluation {
  std::string model;
  std::string frames;
  std::string loads;
  std::string report;
  bool json = false;
};

/// Declares --model, --frames, --loads, --json and --report; `evaluation` must live as long as the action.
void add_force_evaluation(Command& command, ForceEvaluation& evaluation);

/// Prints what dermis, its look-up tables and a `further` estimator (or null) make of known loads.
[[nodiscard]] Status evaluate_forces(const ForceEvaluation& evaluation, learn::calibration::FurtherEstimator* further);

}  // namespace dermis::app
