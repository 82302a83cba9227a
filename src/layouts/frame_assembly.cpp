// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "layouts/frame_assembly.hpp"

#include <algorithm>
#include <limits>

namespace dermis::layouts {
namespace {

constexpr std::int64_t kMostLost = 1000;  // more missing frames are a restart of the device
constexpr std::int64_t kMostLateNanos = 1'000'000'000;

bool holds(const std::vector<std::uint64_t>& values, const std::optional<std::uint64_t>& flags) {
  return flags && std::find(values.begin(), values.end(), *flags) != values.end();
}

}  // namespace

FrameAssembly::FrameAssembly(const Layout& layout, std::size_t array, const Moduli& moduli)
    : layout_(layout),
      array_(array),
      shape_(layout.arrays[array].shape),
      has_plain_readings_(layout.scale == 1.0 && layout.offset == 0.0 && !layout.absent),
      readings_(shape_.taxel_count()),
      is_filled_(shape_.taxel_count()),
      frame_number_(moduli.frame),
      time_(moduli.time_ns) {}

bool FrameAssembly::add(const Piece& piece, std::span<const float> numbers, std::size_t bytes, RawFrame& frame) {
  if (piece.array != array_) return false;
  if (filled_ > 0 && piece.frame != first_.frame) end_frame();
  std::optional<std::size_t> begin = begin_of(piece, numbers.size());
  if (begin && is_filled(*begin, numbers.size())) {
    end_frame();
    begin = begin_of(piece, numbers.size());
  }
  if (!begin) {
    damage(bytes);
    return false;
  }
  if (filled_ == 0) begin_frame(piece);
  fill(*begin, numbers);
  bytes_ += bytes;
  return filled_ == readings_.size() && deliver(frame);
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

bool FrameAssembly::is_filled(std::size_t begin, std::size_t count) const noexcept {
  if (filled_ == 0) return false;
  const auto first = is_filled_.begin() + static_cast<std::ptrdiff_t>(begin);
  return std::find(first, first + static_cast<std::ptrdiff_t>(count), 1) != first + static_cast<std::ptrdiff_t>(count);
}

void FrameAssembly::begin_frame(const Piece& piece) {
  first_ = piece;
  bytes_ = 0;
  std::fill(is_filled_.begin(), is_filled_.end(), 0);
}

void FrameAssembly::fill(std::size_t begin, std::span<const float> numbers) {
  float* const readings = readings_.data() + begin;
  std::copy(numbers.begin(), numbers.end(), readings);
  std::fill_n(is_filled_.data() + begin, numbers.size(), std::uint8_t{1});
  filled_ += numbers.size();
  if (has_plain_readings_) return;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<double>(numbers[i]);
    readings[i] = number == layout_.absent ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(layout_.scale * number + layout_.offset);
  }
}

/// Before the first frame, a part of one is the end of a frame whose beginning nobody saw.
void FrameAssembly::end_frame() {
  if (filled_ == 0) return;
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
  if (holds(layout_.flags.corrupt, first_.flags)) {
    damage(bytes_);
    return false;
  }
  if (holds(layout_.flags.absent, first_.flags)) {
    std::fill(readings_.begin(), readings_.end(), std::numeric_limits<float>::quiet_NaN());
  }
  frame.counts.assign(readings_.begin(), readings_.end());
  describe(frame);
  ++counts_.frames;
  counts_.lost_frames += frame.acquisition.lost_before;
  return true;
}

void FrameAssembly::describe(RawFrame& frame) {
  frame.temperature_celsius = first_.temperature_celsius;
  frame.supply_v = first_.supply_v;
  frame.acquisition = {};
  if (first_.frame) {
    const std::int64_t number = frame_number_.count(*first_.frame, 0);
    const std::int64_t step = last_number_ ? number - *last_number_ : 1;
    if (step > 1 && step <= kMostLost + 1) frame.acquisition.lost_before = static_cast<std::uint32_t>(step - 1);
    frame.acquisition.sequence = static_cast<std::uint64_t>(number);
    last_number_ = number;
  }
  if (first_.time_ns) frame.acquisition.device_time = Nanos(time_.count(*first_.time_ns, kMostLateNanos));
}

}  // namespace dermis::layouts
