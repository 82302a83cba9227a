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

/// Readings that stand side by side.
struct Span {
  std::size_t begin = 0;  ///< The first of the columns,
  std::size_t end = 0;    ///< and the one behind the last.
  std::string name{};     ///< Which all of their names begin with.
  /// As brackets or other separators part its rows, or as the names of its columns count: "r0c0".
  std::optional<FrameShape> shown_shape{};
};

/// One way to understand a line.
struct LineFields {
  std::vector<std::string> fields;    ///< [columns] As in a layout; empty: a reading.
  std::vector<Span> spans;            ///< Of the arrays.
  std::optional<FrameShape> shape{};  ///< As the numbers of rows, columns or taxels tell; 1xN of N taxels in turn.
  std::vector<std::uint64_t> ids{};   ///< Of the arrays that come in turn.
  std::vector<std::string> reasons{};
  double merit = 0.0;
};

/// All ways to understand the columns, the usual first.
[[nodiscard]] std::vector<LineFields> fields_of(const std::vector<Column>& columns);

}  // namespace dermis::bytes::proposals
