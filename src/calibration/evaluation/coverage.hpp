// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/calibration/evaluation.hpp"

namespace dermis::calibration {

[[nodiscard]] Coverage coverage_of(std::span<const JudgedTaxel> taxels);

}  // namespace dermis::calibration
