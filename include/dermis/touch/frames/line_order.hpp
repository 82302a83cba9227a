// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// The directions in which a device sends its lines: how its frames become frames of the array. The members are applied
/// in their order. By default nothing changes.
struct LineOrder {
  std::size_t skip_columns = 0;          ///< First columns that are no taxels, 0 ... kMaxLines - 1.
  bool transpose = false;                ///< A row as sent is a column.
  bool flip_rows = false;                ///< The last row becomes the first.
  bool flip_cols = false;                ///< The last column becomes the first.
  std::vector<std::size_t> row_order{};  ///< Row i of the array is row row_order[i] so far; empty: row i.
  std::vector<std::size_t> col_order{};  ///< The same of columns.
  /// Taxel i of the array, row-major, is reading taxel_order[i] so far, row-major; empty: reading i. Readings that are
  /// not named are dropped.
  std::vector<std::size_t> taxel_order{};
  std::size_t taxel_rows = 1;    ///< Rows of the array, where there is a taxel_order.
  FrameShape taxels_sent{0, 0};  ///< Shape of the frames that are sent, where there is a taxel_order.

  bool operator==(const LineOrder&) const = default;

  /// Nothing changes.
  [[nodiscard]] bool is_plain() const { return *this == LineOrder{}; }

  /// Fails where a list does not name each of its lines once, as "row_order: ...", or a reading twice.
  [[nodiscard]] Status validate() const;

  /// Shape of the array whose device sends frames of `sent`. Fails where nothing is left of them, and where a list
  /// is not as long as its lines are many or taxel_order not for such frames.
  [[nodiscard]] Result<FrameShape> turned(FrameShape sent) const;

  /// Shape of the frames that the device of such an array sends.
  [[nodiscard]] FrameShape sent(FrameShape array) const noexcept;

  /// For each taxel of the array, row-major, its place in a frame of `sent`, for which turned() does not fail.
  [[nodiscard]] std::vector<std::size_t> sent_places(FrameShape sent) const;

 private:
  [[nodiscard]] FrameShape lines_of(FrameShape sent) const noexcept;  // before the lists
  [[nodiscard]] Result<FrameShape> picked(FrameShape sent, FrameShape lines) const;
};

}  // namespace dermis
