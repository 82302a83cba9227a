// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/guided/press_fit.hpp"

namespace dermis::browser {

/// The outcome of a fit as bytes (CBOR). The report of a calibration is there as far as a guide tells it.
[[nodiscard]] std::string outcome_to_bytes(const learn::calibration::FitOutcome& outcome);
/// Errors: they are not what outcome_to_bytes() gives.
[[nodiscard]] Result<learn::calibration::FitOutcome> outcome_from_bytes(std::string_view bytes);

}  // namespace dermis::browser
