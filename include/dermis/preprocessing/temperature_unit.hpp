// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::preprocessing {

/// No sheet is hotter than 200 C. In kelvin that would be -73 C, and none is colder.
[[nodiscard]] constexpr bool looks_like_kelvin(double celsius) noexcept {
  constexpr double kHottestCelsius = 200.0;
  return celsius > kHottestCelsius;
}

}  // namespace dermis::preprocessing
