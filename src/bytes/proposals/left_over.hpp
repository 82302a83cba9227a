// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// Sentences on the lines that hold no readings: "every fifth line begins with 'DEBUG'".
[[nodiscard]] std::vector<std::string> left_over_lines(const std::vector<Line>& lines,
                                                       const std::vector<std::size_t>& members);

/// "fifth", "16th"
[[nodiscard]] std::string ordinal(std::size_t number);

}  // namespace dermis::bytes::proposals
