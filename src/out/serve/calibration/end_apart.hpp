// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/learn/calibration/guided_calibration.hpp"

namespace dermis::out::serve {

/// Ends the calibration while its caller goes on: its end may have to wait for a fit. Who lets go of the answer waits.
[[nodiscard]] std::shared_ptr<void> end_apart(std::shared_ptr<learn::calibration::GuidedCalibration> calibration);

}  // namespace dermis::out::serve
