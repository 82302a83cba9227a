// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

/// Which lines of an array are one node. Lines are counted as rows, then columns; a node is known by its first line.
class JoinedLines {
 public:
  JoinedLines(std::size_t rows, std::size_t cols) : rows_(rows), first_(rows + cols) { separate(); }

  void separate() noexcept { std::iota(first_.begin(), first_.end(), std::size_t{0}); }

  void join(std::size_t a, std::size_t b) noexcept {
    const std::size_t first = std::min(first_[a], first_[b]);
    const std::size_t other = std::max(first_[a], first_[b]);
    std::replace(first_.begin(), first_.end(), other, first);
  }

  /// The lines that the fault joins.
  void join(const LineFault& fault, const ArrayDescription& array) noexcept {
    if (fault.kind == LineFaultKind::shorted_rows) join(fault.place, fault.place + 1);
    if (fault.kind == LineFaultKind::shorted_columns) join(rows_ + fault.place, rows_ + fault.place + 1);
    if (fault.kind == LineFaultKind::shorted_crossing) {
      join(fault.place / array.cols, rows_ + fault.place % array.cols);
    }
  }

  [[nodiscard]] std::size_t first_of(std::size_t line) const noexcept { return first_[line]; }

  /// The node has rows and columns.
  [[nodiscard]] bool crosses(std::size_t line) const noexcept {
    return first_[line] < rows_ && count(first_[line], rows_, first_.size()) > 0;
  }
  [[nodiscard]] bool has_other_row(std::size_t row) const noexcept { return count(first_[row], 0, rows_) > 1; }
  [[nodiscard]] bool has_other_column(std::size_t col) const noexcept {
    return count(first_[rows_ + col], rows_, first_.size()) > 1;
  }
  [[nodiscard]] bool is_first_column(std::size_t col) const noexcept {
    return count(first_[rows_ + col], rows_, rows_ + col) == 0;
  }

 private:
  [[nodiscard]] std::size_t count(std::size_t first, std::size_t from, std::size_t until) const noexcept {
    const auto begin = first_.begin();
    return static_cast<std::size_t>(
        std::count(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(until), first));
  }

  std::size_t rows_;
  std::vector<std::size_t> first_;  // [lines]
};

}  // namespace dermis::touch::compensation
