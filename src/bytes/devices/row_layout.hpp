// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bytes/devices/row_syntax.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::devices {

/// How the lines of a stream make frames.
struct RowLayout {
  FrameShape shape;
  bool line_is_frame = false;  ///< Otherwise a line is a row, and a separator ends the frame.
  std::size_t leading = 0;     ///< Numbers before the readings of each line: 1 for a clock.
};

/// Learns from lines that repeat what is not known beforehand. A first number that rises from frame to frame is a clock
/// and no reading.
class RowLayoutLearner {
 public:
  RowLayoutLearner(const RowSyntax& syntax, const std::optional<FrameShape>& shape) : syntax_(syntax), shape_(shape) {}

  void take(std::span<const std::uint8_t> line);
  /// The device has paused after the lines so far.
  void pause();
  /// No more lines will come.
  void end();
  /// Begins anew. A shape that was given or announced stays.
  void forget() noexcept;

  [[nodiscard]] const std::optional<RowLayout>& layout() const noexcept { return layout_; }
  /// As given or announced; empty where only learning can find it.
  [[nodiscard]] const std::optional<FrameShape>& shape() const noexcept { return shape_; }
  /// Says what the lines so far lack, and the mend; empty where nothing can be said.
  [[nodiscard]] std::string advice() const;
  /// The size nearest to a square of lines that may be frames; empty where they are not, and where the size is known.
  [[nodiscard]] std::optional<FrameShape> likely_shape() const;

 private:
  /// Lines between two separators, as far as they are alike.
  struct Block {
    std::size_t rows = 0;
    std::size_t cols = 0;
    bool even = true;      // all rows have `cols` values
    bool is_clock = true;  // their first numbers never fall
    double first = 0.0;    // number of its first row
    double last = 0.0;     // and of its last row

    [[nodiscard]] bool has_clock() const noexcept;
    [[nodiscard]] std::size_t readings() const noexcept;  // in a row
    [[nodiscard]] bool is_like(const Block& other) const noexcept {
      return rows == other.rows && cols == other.cols && even == other.even;
    }
  };

  /// Lines of as many values, or blocks of one such line each.
  struct Run {
    std::size_t values;
    std::size_t lines;
    bool all_rise;  // their first numbers
  };

  /// The sign that lines are frames: something between them, their mere number, or the end of the stream.
  enum class Sign { divided, number, end };

  void add_row(std::span<const std::uint8_t> line, const ParsedLine& parsed);
  void count_alike(const ParsedLine& parsed);
  void learn_row(const ParsedLine& parsed);
  void learn_given_line();
  void add_separator(LineKind kind);
  void learn_block(bool at_end);
  void learn_given_block();
  void end_of_given();
  void learn_single_line(const Run& run, Sign sign);
  void keep_values(std::span<const std::uint8_t> line, std::size_t values);
  [[nodiscard]] bool lines_are_rows();
  [[nodiscard]] const Block& unread_block() const noexcept { return block_.rows > 0 ? block_ : block_before_; }
  [[nodiscard]] bool all_rise() const noexcept { return alike_lines_ > 1 && rising_lines_ == alike_lines_; }
  [[nodiscard]] Run run() const noexcept { return {block_.cols, alike_lines_, all_rise()}; }
  [[nodiscard]] std::optional<FrameShape> shape_of_line(std::size_t values) const;

  RowSyntax syntax_;
  std::optional<FrameShape> shape_;
  std::optional<RowLayout> layout_;

  Block block_;
  Block block_before_;
  bool separator_seen_ = false;
  std::size_t equal_blocks_ = 0;  // blocks alike, up to block_before_
  std::size_t clock_blocks_ = 0;  // of these, those whose first numbers are a clock
  std::size_t alike_lines_ = 0;   // rows of as many values without a separator, up to the last one
  std::size_t rising_lines_ = 0;  // of these, those from the first on whose first number rises
  std::size_t lone_lines_ = 0;    // of these, those after which there was a pause
  std::size_t paused_at_ = 0;     // alike_lines_ at the last pause
  std::vector<float> values_;     // of these, where one may be a square frame
  bool has_period_ = false;       // they are rows of longer frames
};

/// Says what to print for rows that do not show where a frame begins.
[[nodiscard]] std::string unseparated_rows(std::size_t readings);

}  // namespace dermis::bytes::devices
