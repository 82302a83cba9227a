// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/line_order.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace dermis {
namespace {

Status validate_list(const char* name, const std::vector<std::size_t>& order) {
  std::vector<bool> is_named(order.size());
  for (const std::size_t line : order) {
    if (line < order.size() && !is_named[line]) {
      is_named[line] = true;
      continue;
    }
    return bad_input(std::string(name) + ": must name each line from 0 to " + std::to_string(order.size() - 1) +
                     " once");
  }
  return Done{};
}

Status check_length(const char* name, const std::vector<std::size_t>& order, std::size_t lines) {
  if (order.empty() || order.size() == lines) return Done{};
  return bad_input(std::string(name) + ": has " + std::to_string(order.size()) + " lines, the array " +
                   std::to_string(lines));
}

Status validate_taxels(const std::vector<std::size_t>& order) {
  std::vector<std::size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice == sorted.end()) return Done{};
  return bad_input("taxel_order: names reading " + std::to_string(*twice) + " twice");
}

std::string size_text(FrameShape shape) {
  return std::to_string(shape.rows) + "x" + std::to_string(shape.cols);
}

/// The line before the flip and the list.
std::size_t line_before(std::size_t line, std::size_t lines, bool flip, const std::vector<std::size_t>& order) {
  if (!order.empty()) line = order[line];
  return flip ? lines - 1 - line : line;
}

}  // namespace

Status LineOrder::validate() const {
  if (Status rows = validate_list("row_order", row_order); !rows) return rows;
  if (Status cols = validate_list("col_order", col_order); !cols) return cols;
  return validate_taxels(taxel_order);
}

Result<FrameShape> LineOrder::turned(FrameShape sent) const {
  if (skip_columns >= sent.cols) {
    return bad_input("skip_columns: leaves none of " + std::to_string(sent.cols) + " columns");
  }
  const FrameShape array = lines_of(sent);
  if (Status rows = check_length("row_order", row_order, array.rows); !rows) return rows.error();
  if (Status cols = check_length("col_order", col_order, array.cols); !cols) return cols.error();
  return taxel_order.empty() ? array : picked(sent, array);
}

Result<FrameShape> LineOrder::picked(FrameShape sent, FrameShape lines) const {
  if (sent != taxels_sent) {
    return bad_input("taxel_order: is for frames of " + size_text(taxels_sent) + ", not of " + size_text(sent));
  }
  const std::size_t last = *std::max_element(taxel_order.begin(), taxel_order.end());
  if (last >= lines.taxel_count()) {
    return bad_input("taxel_order: reading " + std::to_string(last) + " is not among " +
                     std::to_string(lines.taxel_count()) + ", counted from 0");
  }
  if (taxel_rows == 0 || taxel_order.size() % taxel_rows != 0) {
    return bad_input("taxel_order: " + std::to_string(taxel_order.size()) + " taxels do not fill " +
                     std::to_string(taxel_rows) + " rows");
  }
  return FrameShape{taxel_rows, taxel_order.size() / taxel_rows};
}

FrameShape LineOrder::sent(FrameShape array) const noexcept {
  if (!taxel_order.empty()) return taxels_sent;
  if (transpose) std::swap(array.rows, array.cols);
  return {array.rows, array.cols + skip_columns};
}

FrameShape LineOrder::lines_of(FrameShape sent) const noexcept {
  const FrameShape lines{sent.rows, sent.cols - skip_columns};
  return transpose ? FrameShape{lines.cols, lines.rows} : lines;
}

std::vector<std::size_t> LineOrder::sent_places(FrameShape sent) const {
  assert(turned(sent));
  const FrameShape lines = lines_of(sent);
  std::vector<std::size_t> places;
  places.reserve(lines.taxel_count());
  for (std::size_t row = 0; row < lines.rows; ++row) {
    for (std::size_t col = 0; col < lines.cols; ++col) {
      std::size_t sent_row = line_before(row, lines.rows, flip_rows, row_order);
      std::size_t sent_col = line_before(col, lines.cols, flip_cols, col_order);
      if (transpose) std::swap(sent_row, sent_col);
      places.push_back(sent_row * sent.cols + skip_columns + sent_col);
    }
  }
  if (taxel_order.empty()) return places;
  std::vector<std::size_t> taxels;
  taxels.reserve(taxel_order.size());
  for (const std::size_t reading : taxel_order) taxels.push_back(places[reading]);
  return taxels;
}

}  // namespace dermis
