// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

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
void add_record(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_emulate(CLI::App& app, Action& action);
void add_convert(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_recover(CLI::App& app, Action& action);
void add_image(CLI::App& app, Action& action);
void add_top(CLI::App& app, Action& action);
void add_serve(CLI::App& app, Action& action);

/// A check of a number: CLI11 would wrap a negative one round.
[[nodiscard]] std::string not_negative(const std::string& text);

}  // namespace dermis::app
