// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/calibration/evaluation.hpp"

namespace dermis::learn::calibration {

/// Fills by_force, by_temperature, by_supply, by_contacts, by_onset and by_direction from the judged taxels and totals.
void break_down(Evaluation& evaluation);

}  // namespace dermis::learn::calibration
