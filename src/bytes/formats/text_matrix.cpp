// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::formats {
namespace {

/// Lines that follow each other, all with the same number of values.
struct Block {
  std::vector<float> values;
  std::size_t rows = 0;
  std::size_t cols = 0;

  [[nodiscard]] FrameShape shape() const { return {rows, cols}; }
};

/// Else it ends a block. Separators with nothing between are missing readings.
bool is_row(std::string_view line) {
  Cells cells(line, Cells::Separator::any);
  std::string_view cell;
  float value = 0.0F;
  return cells.next_filled(cell) ? parse_reading(cell, value) : !files::trimmed(line).empty();
}

/// Values of a row; a separator at its end ends the last one.
std::size_t count_values(std::string_view line) {
  Cells cells(line, Cells::Separator::any);
  std::size_t count = 0;
  std::string_view cell;
  while (cells.next(cell)) ++count;
  return count > 1 && cell.empty() ? count - 1 : count;
}

class TextMatrix final : public FrameSource {
 public:
  TextMatrix(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : lines_(std::move(in), name), options_(options) {}

  /// Reads the first block.
  Status open() {
    if (const Status read = read_block(); !read) return read.error();
    if (block_.rows == 0) return lines_.error("there is no line of numbers");
    if (is_cut_ && options_.shape) return Done{};
    shape_ = block_.shape();
    if (is_only_one_ && !options_.shape) question_lines();
    return check_shape(lines_.name(), *shape_, options_.shape);
  }

  Result<bool> next(RawFrame& frame) override {
    if (frames_ > 0) {
      if (const Status read = read_block(); !read) return read.error();
    }
    if (is_cut_) tell_cut(options_, lines_.place(), frames_);
    if (is_cut_ || block_.rows == 0) return false;
    if (block_.shape() != *shape_) {
      return lines_.error("a block of " + files::size_text(block_.shape()) + " numbers ends here, the first has " +
                          files::size_text(*shape_));
    }
    const Result<Nanos> time = time_of_frame(lines_.place(), frames_, *options_.rate_hz);
    if (!time) return time.error();
    ++frames_;
    begin_frame(frame, *time);
    frame.counts = block_.values;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_ ? shape_ : options_.shape; }
  [[nodiscard]] std::string place() const override { return lines_.place(); }

 private:
  [[nodiscard]] bool is_full() const {
    const std::optional<FrameShape> known = shape();
    return known && block_.rows == known->rows;
  }

  /// The next block into block_, without rows at the end.
  Status read_block() {
    block_.rows = 0;
    while (!is_full()) {
      std::string_view line;
      const Result<bool> more = lines_.next(line);
      if (!more) return more.error();
      if (*more && is_row(line)) {
        if (Status read = read_row(line); !read) return read;
      } else if (block_.rows > 0 || !*more) {
        is_cut_ = is_cut_ || (!*more && shape() && block_.rows > 0);
        is_only_one_ = !*more;
        break;
      }
      if (is_cut_) break;
    }
    return Done{};
  }

  Status read_row(std::string_view line) {
    if (block_.rows == kMaxLines) {
      return lines_.error("more than 1024 rows without a blank line between: say how many rows and cols a frame has");
    }
    if (block_.rows == 0) block_.cols = count_values(line);
    if (block_.rows == 0 && options_.shape && block_.cols == options_.shape->taxel_count()) return read_frame(line);
    if (block_.cols > kMaxLines) return lines_.error("has more than 1024 values");
    block_.values.resize((block_.rows + 1) * block_.cols);
    const Status read =
        parse_row(line, Cells::Separator::any, std::span(block_.values).subspan(block_.rows * block_.cols));
    if (!read && !(lines_.was_cut() && frames_ > 0)) return lines_.error(read.error().message);
    const std::optional<FrameShape> known = shape();
    is_cut_ = !read || (lines_.was_cut() && count_values(line) < (known ? known->cols : block_.cols));
    ++block_.rows;
    return Done{};
  }

  /// A line that holds a whole frame.
  Status read_frame(std::string_view line) {
    block_.values.resize(options_.shape->taxel_count());
    const Status read = parse_row(line, Cells::Separator::any, block_.values);
    if (!read && !(lines_.was_cut() && frames_ > 0)) return lines_.error(read.error().message);
    is_cut_ = !read;
    block_.rows = options_.shape->rows;
    block_.cols = options_.shape->cols;
    return Done{};
  }

  /// A file without a blank line may hold one frame, or a frame a line.
  void question_lines() const {
    const bool may_be_frames = block_.rows > 1 && block_.cols > 1 && block_.rows != block_.cols;
    if (!may_be_frames || !options_.notice) return;
    std::size_t cols = block_.cols;
    for (cols = static_cast<std::size_t>(std::sqrt(static_cast<double>(cols))); block_.cols % cols != 0;) --cols;
    options_.notice(lines_.name() + ": " + std::to_string(block_.rows) + " lines of " + std::to_string(block_.cols) +
                    " numbers are read as one frame; if each line is a frame, give rows and cols, as rows=" +
                    std::to_string(block_.cols / cols) + " and cols=" + std::to_string(cols));
  }

  TextLines lines_;
  ImportOptions options_;
  std::optional<FrameShape> shape_;
  Block block_;
  bool is_cut_ = false;       ///< The text ends within the block.
  bool is_only_one_ = false;  ///< The text ends behind the block.
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_text_matrix(std::unique_ptr<std::istream> in, const std::string& name,
                                                      const ImportOptions& options) {
  return open_as<TextMatrix>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
