// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/learn/calibration/guided_calibration.hpp"

namespace dermis::out::serve {

/// How far a calibration is.
struct CalibrationProgress {
  std::string array;
  learn::calibration::GuideState state;  ///< Stage `none` after a calibration was cancelled.
};

[[nodiscard]] bytes::ros_messages::CalibrationState calibration_message(CalibrationProgress progress);

}  // namespace dermis::out::serve
