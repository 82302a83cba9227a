// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "commands.hpp"

namespace dermis::app {

/// `dermis fleet list` and `dermis fleet page`: the robots of a hub.
void add_fleet_list(Command& fleet);
void add_fleet_page(Command& fleet);

}  // namespace dermis::app
