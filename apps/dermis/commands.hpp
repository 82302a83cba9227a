// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <CLI/App.hpp>
#include <functional>

#include "dermis/core/result.hpp"

namespace dermis::app {

/// What the chosen subcommand does; set by its add_ function when it is parsed.
using Action = std::function<Status()>;

/// Each adds one subcommand with its options to `app` and, where that subcommand is chosen, sets `action`.
void add_simulate(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_circuit(CLI::App& app, Action& action);
void add_doctor(CLI::App& app, Action& action);
void add_paper(CLI::App& app, Action& action);

}  // namespace dermis::app
