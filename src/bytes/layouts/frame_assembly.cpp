// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/frame_assembly.hpp"

#include <algorithm>

namespace dermis::bytes::layouts {
FrameAssembly::FrameAssembly(const Layout& layout, std::size_t array, const Moduli& moduli)
    : array_(array),
      shape_(layout.arrays[array].shape),
      fields_(layout, moduli),
      readings_(shape_.taxel_count()),
      filled_in_(shape_.taxel_count()) {}

bool FrameAssembly::add(const Piece& piece, std::span<const float> numbers, std::size_t bytes, RawFrame& frame) {
  if (piece.array != array_) return false;
  if (piece.first && numbers.size() > 1) {
    const std::uint64_t inside = readings_.size() - std::min<std::uint64_t>(*piece.first, readings_.size());
    if (inside == 0) return is_outside(piece);
    numbers = numbers.first(std::min<std::uint64_t>(numbers.size(), inside));
  }
  if (filled_ > 0 && piece.frame != first_.frame) end_frame();
  std::optional<std::size_t> begin = begin_of(piece, numbers.size());
  if (begin && (has_come(*begin, numbers.size()) || begins_again(*begin, numbers.size()))) {
    end_frame();
    begin = begin_of(piece, numbers.size());
  }
  if (!begin) {
    damage(bytes);
    return is_outside(piece);
  }
  if (filled_ == 0) begin_frame(piece);
  fill(*begin, numbers);
  bytes_ += bytes;
  return filled_ == readings_.size() && deliver(frame);
}

/// A board may have more channels than taxels.
bool FrameAssembly::is_outside(const Piece& piece) {
  outside_ = piece;
  return false;
}

/// Index of the first taxel; empty where the array does not have all of them.
std::optional<std::size_t> FrameAssembly::begin_of(const Piece& piece, std::size_t count) const noexcept {
  std::size_t begin = filled_;
  if (piece.first) {
    begin = std::min<std::uint64_t>(*piece.first, readings_.size());
  } else if (piece.row) {
    const std::uint64_t col = piece.col.value_or(0);
    if (*piece.row >= shape_.rows || col >= shape_.cols || count > shape_.cols - col) return std::nullopt;
    begin = *piece.row * shape_.cols + col;
  }
  const bool is_behind_the_last = !piece.first && !piece.row && begin + count > readings_.size();
  if (is_behind_the_last) return count <= readings_.size() ? std::optional<std::size_t>(0) : std::nullopt;
  return begin + count <= readings_.size() ? std::optional(begin) : std::nullopt;
}

/// Readings that came already, but for a part that overlaps with the end of the one before.
bool FrameAssembly::has_come(std::size_t begin, std::size_t count) const noexcept {
  if (filled_ == 0 || count == 0) return false;
  const std::span<const std::uint32_t> part = std::span(filled_in_).subspan(begin, count);
  const bool goes_on = part.front() == number_ && part.back() != number_;
  return !goes_on && std::ranges::find(part, number_) != part.end();
}

/// The first readings come directly behind the last ones: those of this frame were lost. Two parts may come in any
/// order.
bool FrameAssembly::begins_again(std::size_t begin, std::size_t count) const noexcept {
  return begin == 0 && last_end_ == readings_.size() && filled_ > count;
}

void FrameAssembly::begin_frame(const Piece& piece) {
  first_ = piece;
  bytes_ = 0;
  if (++number_ != 0) return;
  std::ranges::fill(filled_in_, 0);
  number_ = 1;
}

void FrameAssembly::fill(std::size_t begin, std::span<const float> numbers) {
  const std::span<float> readings = std::span(readings_).subspan(begin, numbers.size());
  std::ranges::copy(numbers, readings.begin());
  fields_.scale(readings);
  const std::span<std::uint32_t> filled = std::span(filled_in_).subspan(begin, numbers.size());
  filled_ += numbers.size() - static_cast<std::size_t>(std::ranges::count(filled, number_));
  std::ranges::fill(filled, number_);
  last_end_ = begin + numbers.size();
}

/// Before the first frame, a part of one is the end of a frame whose beginning nobody saw.
void FrameAssembly::end_frame() {
  if (filled_ == 0) return;
  most_filled_ = std::max(most_filled_, filled_);
  filled_ = 0;
  if (counts_.frames > 0) ++counts_.damaged_frames;
  skip(bytes_);
}

void FrameAssembly::damage(std::size_t bytes) noexcept {
  ++counts_.damaged_frames;
  skip(bytes);
}

bool FrameAssembly::deliver(RawFrame& frame) {
  filled_ = 0;
  frame.counts.assign(readings_.begin(), readings_.end());
  if (!fields_.write(first_, frame)) {
    damage(bytes_);
    return false;
  }
  ++counts_.frames;
  counts_.lost_frames += frame.acquisition.lost_before;
  return true;
}

std::string FrameAssembly::advice() const {
  const auto number = [](const char* name, const std::optional<std::uint64_t>& value) {
    return value ? std::string(name) + std::to_string(*value) + " " : std::string();
  };
  const std::string shape = std::to_string(shape_.rows) + "x" + std::to_string(shape_.cols);
  if (outside_) {
    return number("row ", outside_->row) + number("col ", outside_->col) + number("first ", outside_->first) +
           "is outside of " + shape + ": lines count from 0, or from 1 as {row-1}";
  }
  const std::size_t most = std::max(most_filled_, filled_);
  if (most == 0) return {};
  return "no frame is complete: at most " + std::to_string(most) + " of " + std::to_string(readings_.size()) +
         " readings came";
}

}  // namespace dermis::bytes::layouts
