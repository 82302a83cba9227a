// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::devices {

enum class LineKind {
  row,        ///< Numbers and nothing else.
  separator,  ///< Ends a frame: empty, or a rule of dashes.
  text,       ///< Ends a frame too: a label or a message.
  damaged,    ///< Numbers and something that cannot be there.
};

struct ParsedLine {
  LineKind kind = LineKind::damaged;
  std::size_t values = 0;  ///< Numbers in the row, those included that had no place.
  double first = 0.0;      ///< The first of them. It may be more than a reading can be: a clock.
  std::size_t cols = 0;    ///< Columns of the frame, where the line has them; else 0.
};

constexpr std::uint32_t kMaxTextReading = (1U << 24U) - 1;  ///< The most of the widest converters, and exact as float.

/// Whether a frame may also be one line of rows * cols values.
enum class SingleLines {
  never,
  allowed,
  only,
};

/// How the lines of a protocol are written.
struct RowSyntax {
  /// `line` ends with '\n'. The first numbers of a row go into `values`, as many as have a place there.
  ParsedLine (*parse)(std::span<const std::uint8_t> line, std::span<float> values) = nullptr;
  /// The shape that a line announces; null where the protocol has no such lines.
  std::optional<FrameShape> (*announced_shape)(std::span<const std::uint8_t> line) = nullptr;
  SingleLines single_lines = SingleLines::never;
  /// Takes a line of any number of values for a frame, as one row; otherwise it must be square where its shape is not
  /// known.
  bool any_size = false;
};

}  // namespace dermis::bytes::devices
