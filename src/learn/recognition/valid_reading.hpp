// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::learn::recognition {

/// The reading of a touch; 0 where it is none: not above 0, not a number, or 1e30 and more.
[[nodiscard]] inline double valid_reading(float reading) noexcept {
  constexpr float kMostReading = 1e30F;
  return reading > 0.0F && reading < kMostReading ? static_cast<double>(reading) : 0.0;
}

}  // namespace dermis::learn::recognition
