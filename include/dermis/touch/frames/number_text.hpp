// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis {

/// The number with so many significant digits (> 0, at most 17), without zeros at its end, in every locale: "0.5",
/// "1.2e+07".
[[nodiscard]] std::string significant_digits(double value, int digits);

/// The number with one digit behind its point, in every locale: "298.1".
[[nodiscard]] std::string tenths(double value);

/// As many digits as tell it from all other numbers of single precision, in every locale: "65535", "0.1".
[[nodiscard]] std::string shortest_text(float value);

}  // namespace dermis
