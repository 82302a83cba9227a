// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/bytes/ros_messages/live_messages.hpp"

namespace dermis::support {

/// A calibration in which no two numbers are alike.
inline bytes::ros_messages::CalibrationState calibration_state(Nanos time) {
  bytes::ros_messages::CalibrationState state;
  state.time = time;
  state.array = "hand";
  state.stage = bytes::ros_messages::CalibrationState::Stage::pressing;
  state.message = "Press r1c0";
  state.taxel = 8;
  state.weight_n = 5.0;
  state.reading = 1.75;
  state.hold_share = 0.5;
  state.presses_done = 3;
  state.presses_total = 12;
  state.median_relative_error = 0.04;
  state.taxel_presses = {1, 0, 2};
  state.hint = bytes::ros_messages::CalibrationState::Hint::other_taxel;
  state.pressed_taxel = 7;
  state.unpressed_relative_error = 0.09;
  state.together_with = 5;
  state.together_reading = 1.5;
  return state;
}

}  // namespace dermis::support
