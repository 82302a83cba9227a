// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/files/taxel_text.hpp"

#include "dermis/core/array_description.hpp"
#include "dermis/files/text.hpp"

namespace dermis::files {

std::optional<TaxelPlace> parse_taxel(std::string_view text) {
  const std::size_t c = text.find('c');
  if (!text.starts_with('r') || c == std::string_view::npos) return std::nullopt;
  TaxelPlace place;
  if (!parse_number(text.substr(1, c - 1), place.row) || !parse_number(text.substr(c + 1), place.col)) {
    return std::nullopt;
  }
  return place;
}

std::string size_text(FrameShape shape) {
  return std::to_string(shape.rows) + "x" + std::to_string(shape.cols);
}

void append_taxel_names(std::string& header, std::size_t rows, std::size_t cols) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) header.append(",").append(taxel_name(row, col));
  }
}

}  // namespace dermis::files
