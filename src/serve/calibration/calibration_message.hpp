// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/calibration/guided_calibration.hpp"
#include "dermis/messages/live_messages.hpp"

namespace dermis::serve {

/// How far a calibration is.
struct CalibrationProgress {
  std::string array;
  calibration::GuideState state;  ///< Stage `none` after a calibration was cancelled.
};

[[nodiscard]] messages::CalibrationState calibration_message(CalibrationProgress progress);

}  // namespace dermis::serve
