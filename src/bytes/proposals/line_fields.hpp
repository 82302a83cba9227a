// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bytes/proposals/line_columns.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::proposals {

/// Readings that stand side by side, or each behind a label of its own.
struct Span {
  std::size_t begin = 0;  ///< The first of the columns,
  std::size_t end = 0;    ///< and the one behind the last.
  std::string name{};     ///< Which all of their names begin with.
  /// As brackets or other separators part its rows, or as the names of its columns count: "r0c0".
  std::optional<FrameShape> shown_shape{};
  std::size_t step = 1;     ///< From the column of a reading to that of the next.
  bool has_labels = false;  ///< Text stands between its readings.

  [[nodiscard]] std::size_t size() const noexcept { return (end - begin + step - 1) / step; }
  [[nodiscard]] bool has(std::size_t column) const noexcept {
    return column >= begin && column < end && (column - begin) % step == 0;
  }
};

/// One way to understand a line.
struct LineFields {
  std::vector<std::string> fields;    ///< [columns] As in a layout; empty: a reading.
  std::vector<Span> spans;            ///< Of the arrays.
  std::optional<FrameShape> shape{};  ///< As the numbers of rows, columns or taxels tell; 1xN of N taxels in turn.
  std::vector<std::uint64_t> ids{};   ///< Of the arrays that come in turn.
  std::vector<std::string> reasons{};
  std::vector<std::string> doubts{};
  double merit = 0.0;
  bool is_part = false;  ///< Lines follow each other until the frame is full.
};

/// All ways to understand the columns, the usual first.
[[nodiscard]] std::vector<LineFields> fields_of(const std::vector<Column>& columns);

}  // namespace dermis::bytes::proposals
