// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "bytes/proposals/draft.hpp"
#include "bytes/proposals/line_columns.hpp"
#include "bytes/proposals/line_fields.hpp"
#include "bytes/proposals/line_groups.hpp"
#include "bytes/proposals/lines.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {

/// Lines that are built alike, and their columns.
struct LinesAlike {
  const std::vector<Line>& lines;
  const LineGroup& group;
  const Numerals& numerals;
  std::vector<Column> columns;
};

/// The pattern of lines that begin frames, where they say a number or a time of these; empty otherwise.
[[nodiscard]] std::string head_of(const LinesAlike& text, const std::vector<std::size_t>& heads);

/// A draft with all but its arrays and its line.
[[nodiscard]] Draft begin_line_draft(const LinesAlike& text, const LineFields& fields, const Known& known);

/// Its line, of a draft whose arrays are known.
void write_line(const LinesAlike& text, const LineFields& fields, Draft& draft);

}  // namespace dermis::bytes::proposals
