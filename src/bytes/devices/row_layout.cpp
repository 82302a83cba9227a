// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/row_layout.hpp"

#include <algorithm>
#include <cmath>

#include "bytes/devices/square_shape.hpp"
#include "bytes/devices/undecoded_bytes.hpp"

namespace dermis::bytes::devices {
namespace {

/// Frames that have to agree before their size is believed. One separator too many may cut a frame into two halves of
/// the same size; three equal pieces in a row it does not make.
constexpr std::size_t kEqualFrames = 3;

/// Frames whose first number rises before it is believed to be a clock. Noise does that once in 40,000 times; a
/// reading under a growing load does it, too, but stops.
constexpr std::size_t kClockFrames = 8;

/// The same where no more lines will come.
constexpr std::size_t kClockFramesAtEnd = 4;

/// Lines without a separator before a line is believed to be a frame: more than a frame has rows, if it has so many
/// columns. 65 rows of 36 columns, 161 of 81 and 17 of 100 may be, but are not known.
std::size_t lines_without_separator(std::size_t values) {
  if (values < 49) return 65;
  if (values < 100) return 161;
  return values < 400 ? 16 : 4;
}

/// The same where no more lines will come: a single frame is not likely.
std::size_t lines_at_end(std::size_t values) {
  return values < 49 ? 33 : 4;
}

/// The same where the device pauses after each of them.
constexpr std::size_t kLoneLines = 4;

/// Values of lines that are kept.
constexpr std::size_t kMostValues = 1U << 20U;

/// How much less lines differ over a period than from one to the next, if they are rows of longer frames.
constexpr double kPeriodicShare = 0.5;

/// Mean difference of lines of `width` values that are `lag` lines apart.
double mean_difference(std::span<const float> values, std::size_t width, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag * width; i < values.size(); ++i) sum += std::abs(values[i] - values[i - lag * width]);
  return sum / static_cast<double>(values.size() - lag * width);
}

/// The shape of so many taxels that is nearest to a square, such as 12x10.
FrameShape near_square(std::size_t taxels) {
  auto cols = static_cast<std::size_t>(std::sqrt(static_cast<double>(taxels)));
  while (cols > 1 && taxels % cols != 0) --cols;
  return {taxels / cols, cols};
}

/// "rows=12&cols=10"
std::string given_as(const FrameShape& shape) {
  return "rows=" + std::to_string(shape.rows) + "&cols=" + std::to_string(shape.cols);
}

}  // namespace

void RowLayoutLearner::take(std::span<const std::uint8_t> line) {
  if (!shape_ && syntax_.announced_shape != nullptr) shape_ = syntax_.announced_shape(line);
  const ParsedLine parsed = syntax_.parse(line, {});
  if (parsed.kind == LineKind::row) {
    add_row(line, parsed);
  } else if (parsed.kind == LineKind::damaged) {
    block_.even = false;
  } else {
    add_separator(parsed.kind);
  }
}

void RowLayoutLearner::add_row(std::span<const std::uint8_t> line, const ParsedLine& parsed) {
  count_alike(parsed);
  keep_values(line, parsed.values);
  if (shape_) {
    learn_given_line();
  } else {
    learn_row(parsed);
  }
}

void RowLayoutLearner::count_alike(const ParsedLine& parsed) {
  const bool alike = block_.rows > 0 && block_.cols == parsed.values;
  if (!alike) {
    alike_lines_ = rising_lines_ = lone_lines_ = paused_at_ = 0;
    values_.clear();
    has_period_ = false;
  }
  const bool rises = !alike || parsed.first > block_.last;
  if (rises && rising_lines_ == alike_lines_) ++rising_lines_;
  ++alike_lines_;

  block_.even = block_.even && (alike || block_.rows == 0);
  block_.is_clock = block_.is_clock && (block_.rows == 0 || parsed.first >= block_.last);
  if (block_.rows == 0) block_.first = parsed.first;
  block_.last = parsed.first;
  block_.cols = parsed.values;
  ++block_.rows;
}

/// Rows that follow a separator need no other behind them; a message of the device is none.
void RowLayoutLearner::learn_given_line() {
  const std::size_t taxels = shape_->taxel_count();
  if (syntax_.single_lines != SingleLines::never && block_.cols == taxels) {
    layout_ = {*shape_, true, 0};
  } else if (syntax_.single_lines != SingleLines::never && block_.cols == taxels + 1) {
    if (all_rise() && alike_lines_ >= kClockFrames) layout_ = {*shape_, true, 1};
  } else if (separator_seen_ && block_.cols == shape_->cols && alike_lines_ == std::min<std::size_t>(shape_->rows, 2)) {
    layout_ = {*shape_, false, 0};
  }
}

void RowLayoutLearner::learn_row(const ParsedLine& parsed) {
  if (parsed.cols > 0) {
    if (alike_lines_ >= kEqualFrames) layout_ = {{parsed.values / parsed.cols, parsed.cols}, true, 0};
    return;
  }
  const bool is_frame = syntax_.single_lines == SingleLines::only;
  const std::size_t enough = is_frame ? kEqualFrames : lines_without_separator(parsed.values);
  if (alike_lines_ % enough == 0) learn_single_line(run(), is_frame ? Sign::divided : Sign::number);
}

void RowLayoutLearner::add_separator(LineKind kind) {
  separator_seen_ = separator_seen_ || kind == LineKind::separator;
  if (block_.rows == 0) return;
  const bool repeats = block_.even && block_.is_like(block_before_);
  const bool rises = block_.is_clock && (block_before_.rows == 0 || block_.first > block_before_.last);
  equal_blocks_ = repeats ? equal_blocks_ + 1 : 1;
  clock_blocks_ = rises ? (repeats ? clock_blocks_ + 1 : 1) : 0;
  block_before_ = block_;
  block_ = {};
  if (shape_) {
    learn_given_block();
  } else {
    learn_block(false);
  }
}

/// A block of fewer rows is the end of a frame, whose beginning nobody saw.
void RowLayoutLearner::learn_given_block() {
  if (!block_before_.even || block_before_.rows > shape_->rows) return;
  if (block_before_.cols == shape_->cols) layout_ = {*shape_, false, 0};
  if (block_before_.cols == shape_->cols + 1 && clock_blocks_ >= kEqualFrames) layout_ = {*shape_, false, 1};
}

/// Learns from blocks without an end.
void RowLayoutLearner::learn_block(bool at_end) {
  if (!block_before_.even || equal_blocks_ < kEqualFrames) return;
  const std::size_t cols = block_before_.cols;
  const bool all_rise = clock_blocks_ == equal_blocks_ && cols > 1;
  if (block_before_.rows == 1) return learn_single_line({cols, equal_blocks_, all_rise}, Sign::divided);
  if (!all_rise) layout_ = {{block_before_.rows, cols}, false, 0};
  if (all_rise && (at_end || clock_blocks_ >= kClockFrames)) layout_ = {{block_before_.rows, cols - 1}, false, 1};
}

void RowLayoutLearner::learn_single_line(const Run& run, Sign sign) {
  if (syntax_.single_lines == SingleLines::never) return;
  const std::size_t leading = run.all_rise && run.values > 1 ? 1 : 0;
  if (leading > 0 && run.lines < (sign == Sign::end ? kClockFramesAtEnd : kClockFrames)) return;
  const std::optional<FrameShape> shape = shape_of_line(run.values - leading);
  if (!shape || (sign != Sign::divided && leading == 0 && lines_are_rows())) return;
  layout_ = {*shape, true, leading};
}

std::optional<FrameShape> RowLayoutLearner::shape_of_line(std::size_t values) const {
  const std::optional<FrameShape> square = square_shape(values);
  if (square || !syntax_.any_size) return square;
  return FrameShape{1, values};
}

void RowLayoutLearner::keep_values(std::span<const std::uint8_t> line, std::size_t values) {
  const bool may_be_square =
      syntax_.single_lines == SingleLines::allowed && !syntax_.any_size && square_shape(values).has_value();
  if (shape_ || !may_be_square || values_.size() > kMostValues) return;
  const std::size_t kept = values_.size();
  values_.resize(kept + values);
  syntax_.parse(line, std::span(values_).subspan(kept));
}

/// Whether lines are most like those a few lines before, not like the one before: rows of frames.
bool RowLayoutLearner::lines_are_rows() {
  const std::size_t lines = values_.size() / block_.cols;
  const double next = lines > 1 ? mean_difference(values_, block_.cols, 1) : 0.0;
  for (std::size_t lag = 2; lag <= lines / 2; ++lag) {
    has_period_ = has_period_ || mean_difference(values_, block_.cols, lag) < kPeriodicShare * next;
  }
  values_.clear();
  return has_period_;
}

void RowLayoutLearner::pause() {
  if (layout_ || alike_lines_ == paused_at_) return;
  lone_lines_ = alike_lines_ == paused_at_ + 1 ? lone_lines_ + 1 : 0;
  paused_at_ = alike_lines_;
  if (lone_lines_ >= kLoneLines && !shape_) learn_single_line(run(), Sign::divided);
}

void RowLayoutLearner::end() {
  if (layout_) return;
  if (shape_) return end_of_given();
  if (block_before_.rows > 0) return learn_block(true);
  if (block_.rows > 0 && alike_lines_ >= lines_at_end(block_.cols)) learn_single_line(run(), Sign::end);
}

/// A file may hold one frame and no separator.
void RowLayoutLearner::end_of_given() {
  const bool is_clock = all_rise() && alike_lines_ >= kClockFramesAtEnd;
  const bool is_frame = syntax_.single_lines != SingleLines::never && block_.cols == shape_->taxel_count() + 1;
  if (is_frame && is_clock) layout_ = {*shape_, true, 1};
  if (block_.even && block_.cols == shape_->cols && block_.rows == shape_->rows) layout_ = {*shape_, false, 0};
}

void RowLayoutLearner::forget() noexcept {
  block_ = block_before_ = {};
  separator_seen_ = false;
  alike_lines_ = rising_lines_ = equal_blocks_ = clock_blocks_ = lone_lines_ = paused_at_ = 0;
  values_.clear();
}

bool RowLayoutLearner::Block::has_clock() const noexcept {
  return is_clock && last > first && cols > 1;
}

std::size_t RowLayoutLearner::Block::readings() const noexcept {
  return cols - (has_clock() ? 1 : 0);
}

std::optional<FrameShape> RowLayoutLearner::likely_shape() const {
  const Block& block = unread_block();
  const bool may_be_frame = !layout_ && !shape_ && block_before_.rows <= 1 && block.rows > 0 && block.readings() > 1;
  return may_be_frame ? std::optional(near_square(block.readings())) : std::nullopt;
}

std::string RowLayoutLearner::advice() const {
  const Block& block = unread_block();
  if (layout_ || block.rows == 0) return {};
  const bool has_clock = block.has_clock();
  const std::size_t readings = block.readings();
  const std::string what = (has_clock ? "a time and " : "") + std::to_string(readings) + " readings";
  if (shape_ && readings == shape_->cols) {
    return block.rows > shape_->rows ? unseparated_rows(readings) : std::string();
  }
  if (shape_) return "a line has " + what + ": check rows and cols";
  const std::optional<FrameShape> likely = likely_shape();
  if (!likely) return {};
  const std::string given = "give rows and cols, as " + given_as(*likely);
  if (syntax_.single_lines == SingleLines::only) return "a line has " + what + ": " + given;
  return "a line has " + what + ". If it is a frame, " + given +
         "; if it is a row, print an empty line between frames, or whole frames in one line";
}

std::string unseparated_rows(std::size_t readings) {
  return "nothing divides the frames of rows of " + std::to_string(readings) +
         " readings: print an empty line between frames, or whole frames in one line";
}

}  // namespace dermis::bytes::devices
