// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "bytes/proposals/line_fields.hpp"
#include "bytes/proposals/lines.hpp"
#include "bytes/proposals/smoothness.hpp"

namespace dermis::bytes::proposals {

/// The readings of a span, of each of the first `most` members.
[[nodiscard]] Readings readings_of_lines(const std::vector<Line>& lines, const std::vector<std::size_t>& members,
                                         const Span& span, std::size_t most);

/// The same, of lines that follow each other until there are `taxels`.
[[nodiscard]] Readings readings_of_taxels(const std::vector<Line>& lines, const std::vector<std::size_t>& members,
                                          const Span& span, std::size_t taxels, std::size_t most);

/// How much more alike lines are that lie so many apart than those side by side, -0.5 to 0.5.
[[nodiscard]] double gain_of_rows(const Readings& lines, std::size_t rows);

}  // namespace dermis::bytes::proposals
