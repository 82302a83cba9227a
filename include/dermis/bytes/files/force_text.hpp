// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Reads a force [N] as people write it: "1.96", "1.96 N", "200 g" or "0.2kg", which standard gravity pulls. nan and
/// inf are numbers. A number alone is in `usual`, a unit of force or mass. The error names the text and the units,
/// without a place.
[[nodiscard]] Result<double> parse_force(std::string_view text, std::string_view usual = "N");

/// Reads a pressure [Pa]: "20", which is in kPa, "20 kPa", "500 Pa" or "0.1 MPa".
[[nodiscard]] Result<double> parse_pressure(std::string_view text);

/// Whether parse_force() knows it, as "kg".
[[nodiscard]] bool is_force_unit(std::string_view name);

}  // namespace dermis::bytes::files
