// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "command_line.hpp"
#include "recognising/labelled_examples.hpp"

namespace dermis::app {

/// Declares --in, --tare, --tare-force, --arrays, --extra, --label and --labels, which it returns; `examples` must live
/// as long as the action.
Option add_example_options(Command& command, recognising::ExampleOptions& examples);

/// The same of examples to learn from, whose --labels are required; and --model, --frames and --rate.
void add_taught_examples(Command& command, recognising::ExampleOptions& examples);

}  // namespace dermis::app
