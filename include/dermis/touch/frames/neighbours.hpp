// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>

#include "dermis/touch/frames/axis.hpp"

namespace dermis {

/// The taxels around one, itself among them, as row-major indices in rising order; at the edges there are fewer. With
/// the reach of 1 in both directions these are the taxel and its 8 neighbours.
///
///   for (const std::size_t near : Neighbours(rows, cols, taxel)) ...
class Neighbours {
 public:
  /// `taxel` is one of an array of `rows` x `cols`; `reach`: most rows and most columns away.
  constexpr Neighbours(std::size_t rows, std::size_t cols, std::size_t taxel,
                       PerAxis<std::size_t> reach = {.row = 1, .column = 1}) noexcept
      : cols_(cols) {
    const std::size_t row = taxel / cols;
    const std::size_t col = taxel % cols;
    const std::size_t first_row = row - std::min(row, reach.row);
    const std::size_t last_row = std::min(row + reach.row, rows - 1);
    const std::size_t first_col = col - std::min(col, reach.column);
    const std::size_t last_col = std::min(col + reach.column, cols - 1);
    first_ = first_row * cols + first_col;
    width_ = last_col - first_col + 1;
    end_ = first_ + (last_row - first_row + 1) * cols;
  }

  class Iterator {
   public:
    constexpr Iterator(std::size_t taxel, std::size_t width, std::size_t cols) noexcept
        : taxel_(taxel), row_end_(taxel + width), width_(width), cols_(cols) {}

    [[nodiscard]] constexpr std::size_t operator*() const noexcept { return taxel_; }
    constexpr Iterator& operator++() noexcept {
      if (++taxel_ == row_end_) {
        row_end_ += cols_;
        taxel_ = row_end_ - width_;
      }
      return *this;
    }
    [[nodiscard]] constexpr bool operator==(const Iterator& other) const noexcept { return taxel_ == other.taxel_; }

   private:
    std::size_t taxel_;
    std::size_t row_end_;  // behind the last one of this row
    std::size_t width_;
    std::size_t cols_;
  };

  [[nodiscard]] constexpr Iterator begin() const noexcept { return {first_, width_, cols_}; }
  [[nodiscard]] constexpr Iterator end() const noexcept { return {end_, width_, cols_}; }

 private:
  std::size_t cols_;
  std::size_t first_ = 0;
  std::size_t width_ = 0;
  std::size_t end_ = 0;  // below the first one of the last row
};

}  // namespace dermis
