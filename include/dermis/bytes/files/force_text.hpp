// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Reads a force [N] as people write it: "1.96", "1.96 N", "200 g" or "0.2kg", which standard gravity pulls. nan and
/// inf are numbers. The error names the text and the units, without a place.
[[nodiscard]] Result<double> parse_force(std::string_view text);

}  // namespace dermis::bytes::files
