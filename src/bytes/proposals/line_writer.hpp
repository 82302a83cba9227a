// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bytes/proposals/line_fields.hpp"
#include "bytes/proposals/lines.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {

/// What stands at a column: a field of a layout, or the readings of an array up to column `end`.
struct Place {
  std::string field;    ///< "time_ms", "values" or the name of an array.
  std::size_t end = 0;  ///< The column behind it.
  layouts::Role role = layouts::Role::values;
};

/// The pattern of a line whose numbers and times are these places. `word`: where the name of an array stands, and its
/// size.
[[nodiscard]] std::string pattern_of(const Line& line, const std::vector<Place>& places, std::size_t word_at,
                                     std::size_t word_size);

/// Where in the text of the line each place stands.
void add_parts(const Line& line, const std::vector<Place>& places, std::vector<Part>& parts);

}  // namespace dermis::bytes::proposals
