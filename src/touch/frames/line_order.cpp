// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/line_order.hpp"

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

/// The line before the flip and the list.
std::size_t line_before(std::size_t line, std::size_t lines, bool flip, const std::vector<std::size_t>& order) {
  if (!order.empty()) line = order[line];
  return flip ? lines - 1 - line : line;
}

}  // namespace

Status LineOrder::validate() const {
  if (Status rows = validate_list("row_order", row_order); !rows) return rows;
  return validate_list("col_order", col_order);
}

Result<FrameShape> LineOrder::turned(FrameShape sent) const {
  if (skip_columns >= sent.cols) {
    return bad_input("skip_columns: leaves none of " + std::to_string(sent.cols) + " columns");
  }
  FrameShape array{sent.rows, sent.cols - skip_columns};
  if (transpose) std::swap(array.rows, array.cols);
  if (Status rows = check_length("row_order", row_order, array.rows); !rows) return rows.error();
  if (Status cols = check_length("col_order", col_order, array.cols); !cols) return cols.error();
  return array;
}

FrameShape LineOrder::sent(FrameShape array) const noexcept {
  if (transpose) std::swap(array.rows, array.cols);
  return {array.rows, array.cols + skip_columns};
}

std::vector<std::size_t> LineOrder::sent_places(FrameShape sent) const {
  const Result<FrameShape> array = turned(sent);
  assert(array);
  std::vector<std::size_t> places;
  places.reserve(array->taxel_count());
  for (std::size_t row = 0; row < array->rows; ++row) {
    for (std::size_t col = 0; col < array->cols; ++col) {
      std::size_t sent_row = line_before(row, array->rows, flip_rows, row_order);
      std::size_t sent_col = line_before(col, array->cols, flip_cols, col_order);
      if (transpose) std::swap(sent_row, sent_col);
      places.push_back(sent_row * sent.cols + skip_columns + sent_col);
    }
  }
  return places;
}

}  // namespace dermis
