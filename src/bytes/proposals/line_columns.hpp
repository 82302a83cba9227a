// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bytes/proposals/line_groups.hpp"
#include "bytes/proposals/lines.hpp"
#include "bytes/proposals/series.hpp"

namespace dermis::bytes::proposals {

/// A number or time that stands at the same place in all lines of a group.
struct Column {
  Token::Kind kind = Token::Kind::number;
  std::size_t run = 0;   ///< Numbers of a run stand side by side, with nothing but separators between them.
  std::string name{};    ///< In the head of the table.
  std::string label{};   ///< The text before it.
  std::string before{};  ///< What separates it from the number before it, without blanks.
  std::string field{};   ///< What it holds, as in a layout; empty: a reading.
  std::string reason{};  ///< A sentence on it.
  Series series{};       ///< Of those that may hold something else than readings.
  bool is_counted_from_1 = false;
  bool varies = false;
  bool has_fractions = false;
  bool has_signs = false;  ///< And fractions: some of its numbers are below 0.
};

/// The columns of a group of lines, with the fields of those that hold something else than readings. A column that
/// counts through the same numbers has the field "cycle", one whose few numbers come in turn "turn". Empty where there
/// is too much text between numbers, and where all stands still for 20 lines, fractions too.
/// `is_head`: no readings stand in these lines.
[[nodiscard]] std::vector<Column> columns_of(const std::vector<Line>& lines, const LineGroup& group,
                                             const Numerals& numerals, bool is_head);

}  // namespace dermis::bytes::proposals
