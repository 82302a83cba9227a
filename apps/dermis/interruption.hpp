// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis::app {

/// From here on, SIGINT, SIGTERM and SIGHUP end the process at once, with nothing half-written. The exit status is that
/// of a shell: 128 and the signal. Call it before work whose half is worth nothing, and before it starts threads; live
/// commands look at stop_flag().
void end_when_interrupted();

/// Says this then, in place of "interrupted; nothing is half-written"; empty: nothing. Thread-safe.
void say_when_interrupted(const std::string& text);

}  // namespace dermis::app
