// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "acquisition/line_reader.hpp"
#include "dermis/acquisition/decoder.hpp"
#include "dermis/core/frame_source.hpp"

namespace dermis::acquisition {

enum class LineKind {
  row,        ///< Numbers and nothing else.
  separator,  ///< Ends a frame: empty, or a rule of dashes.
  text,       ///< Ends a frame too: a label or a message.
  damaged,    ///< Numbers and something that cannot be there.
};

struct ParsedLine {
  LineKind kind = LineKind::damaged;
  std::size_t values = 0;  ///< Numbers in the row, those included that had no place.
};

/// Whether a frame may also be one line of rows * cols values where its shape is not known.
enum class SingleLines {
  never,      ///< Not even where the shape is known.
  of_square,  ///< If the shape may be square.
  of_any,     ///< Taken as one row: to recognise the protocol.
};

/// How the lines of a protocol are written.
struct RowSyntax {
  /// `line` ends with '\n'. The first numbers of a row go into `values`, as many as have a place there.
  ParsedLine (*parse)(std::span<const std::uint8_t> line, std::span<float> values);
  /// The shape that a line announces; null where the protocol has no such lines.
  std::optional<FrameShape> (*announced_shape)(std::span<const std::uint8_t> line);
  SingleLines single_lines;
};

/// Frames as text: a line per row and a separator between frames, or a line per frame. What is not known beforehand is
/// learnt from frames that repeat; the bytes are kept meanwhile, so that these frames are delivered too. A frame is
/// delivered with its last row, and the line after it has to be a separator.
class RowDecoder : public Decoder {
 public:
  RowDecoder(const RowSyntax& syntax, const std::optional<FrameShape>& shape);

  void push(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] bool next(RawFrame& frame) override;
  void idle() override;
  void finish() override { ended_ = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return shape_; }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }

 private:
  enum class Layout { unknown, line_per_row, line_per_frame };

  /// Lines between two separators, as far as they are alike.
  struct Block {
    std::size_t rows = 0;
    std::size_t cols = 0;
    bool even = true;  // all rows have `cols` values

    bool operator==(const Block&) const = default;
  };

  void learn(std::span<const std::uint8_t> line);
  void learn_given(const ParsedLine& line);
  void learn_row(std::size_t values);
  void learn_separator();
  void learn_single_line(std::size_t values);
  void learn_at_end();
  void settle(Layout layout, FrameShape shape);
  void forget_learning() noexcept;

  [[nodiscard]] bool decode_line(std::span<const std::uint8_t> line);
  [[nodiscard]] bool take_row(std::size_t values, std::size_t bytes);
  void take_separator();
  void damage(std::size_t bytes);
  void end_stream();

  RowSyntax syntax_;
  LineReader lines_;
  std::optional<FrameShape> shape_;
  Layout layout_ = Layout::unknown;

  Block block_;
  Block block_before_;
  std::size_t alike_lines_ = 0;   // rows of as many values, up to the last one
  std::size_t equal_blocks_ = 0;  // blocks alike, up to block_before_
  std::size_t lone_lines_ = 0;    // of these rows, those after which there was a pause
  std::size_t paused_at_ = 0;     // alike_lines_ at the last pause

  std::vector<float> values_;  // of the frame that is being read
  std::size_t row_ = 0;        // its rows so far
  std::size_t row_bytes_ = 0;  // and their bytes
  bool complete_ = false;      // the frame is delivered, its separator has not come
  bool damaged_ = false;       // all up to the next separator is skipped
  bool ended_ = false;
  std::uint64_t frame_end_ = 0;
  DecoderCounts counts_;
};

}  // namespace dermis::acquisition
