// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "command_line.hpp"

namespace dermis::app {

// Each declares the options of one command, and what it does.
void add_simulate(Command& command);
void add_calibrate(Command& command);
void add_recalibrate(Command& command);
void add_run(Command& command);
void add_evaluate(Command& command);
void add_learn(Command& command);
void add_recognise(Command& command);
void add_circuit(Command& command);
void add_doctor(Command& command);
void add_check(Command& command);
void add_paper(Command& command);
void add_record(Command& command);
void add_replay(Command& command);
void add_emulate(Command& command);
void add_convert(Command& command);
void add_dataset(Command& command);
void add_describe(Command& command);
void add_info(Command& command);
void add_recover(Command& command);
void add_image(Command& command);
void add_top(Command& command);
void add_watch(Command& command);
void add_serve(Command& command);
void add_fleet(Command& command);

}  // namespace dermis::app
