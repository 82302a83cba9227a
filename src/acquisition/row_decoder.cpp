// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "acquisition/row_decoder.hpp"

#include <algorithm>

#include "acquisition/square_shape.hpp"

namespace dermis::acquisition {
namespace {

constexpr std::size_t kLongestValue = 16;  // digits and separators of a number
constexpr std::size_t kLongestUnknownLine = 1U << 20U;
constexpr std::size_t kKeptWhileLearning = 1U << 20U;  // bytes

/// Frames that have to agree before their size is believed. One separator too many may cut a frame into two halves of
/// the same size; three equal pieces in a row it does not make.
constexpr std::size_t kEqualFrames = 3;

/// Lines without a separator before a line is believed to be a frame: more than a frame has rows, if it has so many
/// columns. 65 rows of 36 columns, 161 of 81 and 17 of 100 may be, but are not known.
std::size_t lines_without_separator(std::size_t values) {
  if (values < 49) return 65;
  if (values < 100) return 161;
  return values < 400 ? 16 : 4;
}

/// The same where no more will come: frames of which there is but one are not likely.
std::size_t lines_at_end(std::size_t values) {
  return values < 49 ? 33 : 4;
}

/// The same where the device pauses after each of them.
constexpr std::size_t kLoneLines = 4;

std::size_t longest_line(const std::optional<FrameShape>& shape) {
  constexpr std::size_t kMessage = 256;
  return shape ? kLongestValue * shape->taxel_count() + kMessage : kLongestUnknownLine;
}

}  // namespace

RowDecoder::RowDecoder(const RowSyntax& syntax, const std::optional<FrameShape>& shape)
    : syntax_(syntax), lines_(longest_line(shape)), shape_(shape) {}

void RowDecoder::push(std::span<const std::uint8_t> bytes) {
  if (ended_) end_stream();
  lines_.push(bytes);
}

bool RowDecoder::next(RawFrame& frame) {
  while (true) {
    const std::span<const std::uint8_t> line = lines_.next();
    if (line.empty()) break;
    if (layout_ == Layout::unknown) {
      learn(line);
      continue;
    }
    const bool whole = decode_line(line);
    lines_.forget();
    if (!whole) continue;
    frame_end_ = lines_.position();
    ++counts_.frames;
    frame.counts.assign(values_.begin(), values_.end());
    frame.temperature_celsius.reset();
    frame.supply_v.reset();
    frame.acquisition = {};
    return true;
  }
  if (!ended_) return false;
  if (layout_ == Layout::unknown) {
    learn_at_end();
    if (layout_ != Layout::unknown) return next(frame);
  }
  end_stream();
  return false;
}

void RowDecoder::idle() {
  if (layout_ != Layout::unknown || alike_lines_ == paused_at_) return;
  lone_lines_ = alike_lines_ == paused_at_ + 1 ? lone_lines_ + 1 : 0;
  paused_at_ = alike_lines_;
  if (lone_lines_ >= kLoneLines) learn_single_line(block_.cols);
}

void RowDecoder::learn(std::span<const std::uint8_t> line) {
  if (!shape_ && syntax_.announced_shape != nullptr) shape_ = syntax_.announced_shape(line);
  const ParsedLine parsed = syntax_.parse(line, {});
  if (shape_) {
    learn_given(parsed);
  } else if (parsed.kind == LineKind::row) {
    learn_row(parsed.values);
  } else if (parsed.kind == LineKind::damaged) {
    block_.even = false;
  } else {
    learn_separator();
  }
  if (layout_ == Layout::unknown && lines_.kept() > kKeptWhileLearning) {
    counts_.skipped_bytes += lines_.kept();
    lines_.forget();
  }
}

/// One line of the length of a row may be the end of a longer one.
void RowDecoder::learn_given(const ParsedLine& line) {
  if (line.kind != LineKind::row) return;
  if (line.values == shape_->taxel_count() && syntax_.single_lines != SingleLines::never) {
    settle(Layout::line_per_frame, *shape_);
    return;
  }
  alike_lines_ = line.values == shape_->cols ? alike_lines_ + 1 : 0;
  if (alike_lines_ == std::min<std::size_t>(shape_->rows, 2)) settle(Layout::line_per_row, *shape_);
}

void RowDecoder::learn_row(std::size_t values) {
  const bool alike = block_.rows > 0 && block_.cols == values;
  block_.even = block_.even && (alike || block_.rows == 0);
  block_.cols = values;
  ++block_.rows;
  if (!alike) alike_lines_ = lone_lines_ = paused_at_ = 0;
  ++alike_lines_;
  if (alike_lines_ >= lines_without_separator(values)) learn_single_line(values);
}

void RowDecoder::learn_single_line(std::size_t values) {
  if (syntax_.single_lines == SingleLines::never) return;
  std::optional<FrameShape> shape = square_shape(values);
  if (!shape && syntax_.single_lines == SingleLines::of_any) shape = {1, values};
  if (shape) settle(Layout::line_per_frame, *shape);
}

/// As long as there was no separator.
void RowDecoder::learn_at_end() {
  const bool is_without_separator = block_before_.rows == 0 && block_.rows > 0;
  if (is_without_separator && alike_lines_ >= lines_at_end(block_.cols)) learn_single_line(block_.cols);
}

void RowDecoder::learn_separator() {
  if (block_.rows == 0) return;
  equal_blocks_ = block_.even && block_ == block_before_ ? equal_blocks_ + 1 : 1;
  block_before_ = block_;
  block_ = {};
  if (!block_before_.even || equal_blocks_ < kEqualFrames) return;
  if (block_before_.rows > 1) {
    settle(Layout::line_per_row, {block_before_.rows, block_before_.cols});
  } else {
    learn_single_line(block_before_.cols);
  }
}

void RowDecoder::settle(Layout layout, FrameShape shape) {
  layout_ = layout;
  shape_ = shape;
  values_.assign(shape.taxel_count(), 0.0F);
  lines_.rewind();
}

void RowDecoder::forget_learning() noexcept {
  block_ = block_before_ = {};
  alike_lines_ = equal_blocks_ = lone_lines_ = paused_at_ = 0;
}

bool RowDecoder::decode_line(std::span<const std::uint8_t> line) {
  const std::size_t wanted = layout_ == Layout::line_per_row ? shape_->cols : shape_->taxel_count();
  const ParsedLine parsed = syntax_.parse(line, std::span(values_).subspan(row_ * wanted, wanted));
  switch (parsed.kind) {
    case LineKind::row:
      if (parsed.values == wanted) return take_row(wanted, line.size());
      damage(line.size());
      break;
    case LineKind::damaged: damage(line.size()); break;
    case LineKind::text: counts_.skipped_bytes += line.size(); [[fallthrough]];
    case LineKind::separator: take_separator(); break;
  }
  return false;
}

bool RowDecoder::take_row(std::size_t values, std::size_t bytes) {
  if (layout_ == Layout::line_per_frame) return true;
  if (complete_ || damaged_) {
    damage(bytes);
    return false;
  }
  row_bytes_ += bytes;
  if (++row_ * values < values_.size()) return false;
  row_ = row_bytes_ = 0;
  complete_ = true;
  return true;
}

void RowDecoder::damage(std::size_t bytes) {
  counts_.skipped_bytes += row_bytes_ + bytes;
  row_ = row_bytes_ = 0;
  complete_ = false;
  damaged_ = true;
  if (layout_ == Layout::line_per_frame) take_separator();
}

void RowDecoder::take_separator() {
  const bool cut = damaged_ || row_ > 0;
  if (cut && counts_.frames > 0) ++counts_.damaged_frames;  // before the first frame it is the end of one
  counts_.skipped_bytes += row_bytes_;
  row_ = row_bytes_ = 0;
  complete_ = damaged_ = false;
}

void RowDecoder::end_stream() {
  ended_ = false;
  counts_.skipped_bytes += lines_.forget_all();
  take_separator();
  forget_learning();
}

}  // namespace dermis::acquisition
