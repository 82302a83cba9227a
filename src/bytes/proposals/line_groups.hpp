// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// Lines that are built alike and hold readings.
struct LineGroup {
  std::vector<std::size_t> members;  ///< Places of the lines, in order.
  /// A word differs from line to line and names an array: its different values, and the most readings beside each.
  std::vector<std::string> names{};
  std::vector<std::size_t> numbers{};  ///< [names] Numbers in a line.
  std::size_t word_at = 0;             ///< Where the word begins in the first member,
};

/// Most groups of lines by how much of the text they are, the largest first.
[[nodiscard]] std::vector<LineGroup> groups_of(const std::vector<Line>& lines);

}  // namespace dermis::bytes::proposals
