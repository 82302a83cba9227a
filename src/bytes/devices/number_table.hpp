// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::devices {

struct NumberTable {
  std::vector<std::size_t> numbers;  ///< Row by row.
  std::size_t rows = 1;
};

/// "0,2;1,3": whole numbers up to `most`, with a semicolon between rows of one length. Empty where it is none.
[[nodiscard]] inline std::optional<NumberTable> number_table(std::string_view text, std::size_t most) {
  NumberTable table;
  std::size_t cols = 0;
  for (std::size_t begin = 0, first = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(",;", begin), text.size());
    const auto number = files::number_within<std::size_t>(text.substr(begin, end - begin), std::size_t{0}, most);
    if (!number) return std::nullopt;
    table.numbers.push_back(*number);
    begin = end + 1;
    if (end < text.size() && text[end] == ',') continue;
    const std::size_t length = table.numbers.size() - first;
    if (first > 0 && length != cols) return std::nullopt;
    cols = length;
    first = table.numbers.size();
    if (end < text.size()) ++table.rows;
  }
  return table;
}

}  // namespace dermis::bytes::devices
