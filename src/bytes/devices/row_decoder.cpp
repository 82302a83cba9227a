// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/row_decoder.hpp"

#include <algorithm>

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kLongestValue = 16;  // digits and separators of a number
constexpr std::size_t kLongestUnknownLine = 1U << 20U;
constexpr std::size_t kKeptWhileLearning = 1U << 20U;  // bytes

std::size_t longest_line(const std::optional<FrameShape>& shape) {
  constexpr std::size_t kMessage = 256;
  return shape ? kLongestValue * shape->taxel_count() + kMessage : kLongestUnknownLine;
}

}  // namespace

RowDecoder::RowDecoder(const RowSyntax& syntax, const std::optional<FrameShape>& shape)
    : syntax_(syntax), lines_(longest_line(shape)), learner_(syntax, shape) {}

void RowDecoder::push(std::span<const std::uint8_t> bytes) {
  if (ended_) end_stream();
  lines_.push(bytes);
}

bool RowDecoder::next(RawFrame& frame) {
  while (true) {
    const std::span<const std::uint8_t> line = lines_.next();
    if (line.empty()) break;
    if (!layout_) {
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
  if (!layout_) {
    learner_.end();
    begin_if_learnt();
    if (layout_) return next(frame);
  }
  end_stream();
  return false;
}

void RowDecoder::idle() {
  if (layout_) return;
  learner_.pause();
  begin_if_learnt();
}

void RowDecoder::learn(std::span<const std::uint8_t> line) {
  learner_.take(line);
  begin_if_learnt();
  if (!layout_ && lines_.kept() > kKeptWhileLearning) {
    counts_.skipped_bytes += lines_.kept();
    lines_.forget();
  }
}

/// Reads the lines again from which the layout was learnt.
void RowDecoder::begin_if_learnt() {
  if (!learner_.layout()) return;
  layout_ = learner_.layout();
  values_.assign(layout_->shape.taxel_count(), 0.0F);
  line_.assign(layout_->leading + (layout_->line_is_frame ? values_.size() : layout_->shape.cols), 0.0F);
  lines_.rewind();
}

bool RowDecoder::decode_line(std::span<const std::uint8_t> line) {
  const ParsedLine parsed = syntax_.parse(line, line_);
  switch (parsed.kind) {
    case LineKind::row:
      if (fits(parsed)) return add_row(line.size());
      damage(line.size());
      break;
    case LineKind::damaged: damage(line.size()); break;
    case LineKind::text: counts_.skipped_bytes += line.size(); [[fallthrough]];
    case LineKind::separator:
      rows_since_separator_ = 0;
      add_separator();
      break;
  }
  return false;
}

/// Only a clock may be more than a reading.
bool RowDecoder::fits(const ParsedLine& line) const noexcept {
  return line.values == line_.size() && (line.cols == 0 || line.cols == layout_->shape.cols) &&
         (layout_->leading > 0 || line.first <= kMaxTextReading);
}

bool RowDecoder::add_row(std::size_t bytes) {
  ++rows_since_separator_;
  if (complete_ || damaged_) {
    damage(bytes);
    return false;
  }
  const std::span<const float> readings = std::span(line_).subspan(layout_->leading);
  std::copy(readings.begin(), readings.end(), values_.begin() + static_cast<std::ptrdiff_t>(row_ * readings.size()));
  if (layout_->line_is_frame) return true;
  row_bytes_ += bytes;
  if (++row_ < layout_->shape.rows) return false;
  row_ = row_bytes_ = 0;
  complete_ = true;
  return true;
}

void RowDecoder::damage(std::size_t bytes) {
  counts_.skipped_bytes += row_bytes_ + bytes;
  row_ = row_bytes_ = 0;
  complete_ = false;
  damaged_ = true;
  if (layout_->line_is_frame) add_separator();
}

void RowDecoder::add_separator() {
  const bool cut = damaged_ || row_ > 0;
  if (cut && counts_.frames > 0) ++counts_.damaged_frames;  // before the first frame it is the end of one
  counts_.skipped_bytes += row_bytes_;
  row_ = row_bytes_ = 0;
  complete_ = damaged_ = false;
}

void RowDecoder::end_stream() {
  ended_ = false;
  counts_.skipped_bytes += lines_.forget_all();
  add_separator();
  if (!layout_) learner_.forget();
}

std::string RowDecoder::advice() const {
  if (!layout_) return learner_.advice();
  const bool is_divided = layout_->line_is_frame || rows_since_separator_ <= 2 * layout_->shape.rows;
  return is_divided ? std::string() : unseparated_rows(layout_->shape.cols);
}

}  // namespace dermis::bytes::devices
