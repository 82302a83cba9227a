// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "command_line.hpp"

namespace dermis::app {

// The commands of 'dermis paper': each declares its options, and what it does.
void add_paper_calibrate(Command& command);
void add_paper_evaluate(Command& command);
void add_paper_learn(Command& command);

}  // namespace dermis::app
