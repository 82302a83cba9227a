// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/taxel_text.hpp"

#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::files {
namespace {

Result<TaxelPlace> parse_existing_taxel(std::string_view text, FrameShape shape) {
  const std::optional<TaxelPlace> place = parse_taxel(text);
  if (!place) return bad_input(in_quotes(text) + " is not a place; write r3c5, r0c0:r3c3 or all");
  if (place->row >= shape.rows || place->col >= shape.cols) {
    return bad_input(std::string(text) + " does not exist in a " + size_text(shape) + " array");
  }
  return *place;
}

}  // namespace

std::optional<TaxelPlace> parse_taxel(std::string_view text) {
  const std::size_t c = text.find('c');
  if (!text.starts_with('r') || c == std::string_view::npos) return std::nullopt;
  TaxelPlace place;
  if (!parse_number(text.substr(1, c - 1), place.row) || !parse_number(text.substr(c + 1), place.col)) {
    return std::nullopt;
  }
  return place;
}

Result<TaxelRegion> parse_region(std::string_view text, FrameShape shape) {
  if (text == "all") return TaxelRegion{0, 0, shape.rows - 1, shape.cols - 1};
  const std::size_t colon = text.find(':');
  const Result<TaxelPlace> first = parse_existing_taxel(text.substr(0, colon), shape);
  if (!first) return first.error();
  if (colon == std::string_view::npos) return TaxelRegion{first->row, first->col, first->row, first->col};
  const Result<TaxelPlace> last = parse_existing_taxel(text.substr(colon + 1), shape);
  if (!last) return last.error();
  if (last->row < first->row || last->col < first->col) {
    return bad_input("region " + in_quotes(text) + " is reversed; write its smallest row and column first");
  }
  return TaxelRegion{first->row, first->col, last->row, last->col};
}

std::string size_text(FrameShape shape) {
  return std::to_string(shape.rows) + "x" + std::to_string(shape.cols);
}

void append_taxel_names(std::string& header, std::size_t rows, std::size_t cols) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) header.append(",").append(taxel_name(row, col));
  }
}

}  // namespace dermis::bytes::files
