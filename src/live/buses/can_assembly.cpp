// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <bit>
#include <span>

#include "dermis/live/buses/can_map.hpp"

namespace dermis::live::buses {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::size_t size_of(CanValue value) {
  switch (value) {
    case CanValue::u8:
    case CanValue::i8: return 1;
    case CanValue::f32be:
    case CanValue::f32le: return 4;
    default: return 2;
  }
}

std::uint32_t bits_of(Bytes bytes, bool is_big_endian) {
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    bits = bits << 8U | bytes[is_big_endian ? k : bytes.size() - 1 - k];
  }
  return bits;
}

double number_of(CanValue value, Bytes bytes) {
  const bool is_big_endian = value == CanValue::u16be || value == CanValue::i16be || value == CanValue::f32be;
  const std::uint32_t bits = bits_of(bytes, is_big_endian);
  switch (value) {
    case CanValue::i8: return static_cast<std::int8_t>(bits);
    case CanValue::i16be:
    case CanValue::i16le: return static_cast<std::int16_t>(bits);
    case CanValue::f32be:
    case CanValue::f32le: return static_cast<double>(std::bit_cast<float>(bits));
    default: return bits;
  }
}

/// Empty where the frame is too short.
std::optional<std::size_t> number_at(const CanPlace& place, const CanFrame& frame, std::uint32_t first_id) {
  using Kind = CanPlace::Kind;
  if (place.kind == Kind::nowhere) return 0;
  if (place.kind == Kind::identifier) {
    return frame.id >= first_id ? std::optional<std::size_t>(frame.id - first_id) : std::nullopt;
  }
  if (place.byte >= frame.data.size()) return std::nullopt;
  const unsigned byte = frame.data[place.byte];
  if (place.kind == Kind::byte) return byte;
  return place.kind == Kind::high_nibble ? byte >> 4U : byte & 0xFU;
}

}  // namespace

CanAssembly::CanAssembly(const CanArray& array)
    : array_(array),
      counts_(array.shape.taxel_count()),
      has_come_(array.shape.taxel_count()),
      missing_(array.shape.taxel_count()) {}

/// Where its readings begin among those of the array; empty where the frame is of another.
std::optional<std::size_t> CanAssembly::first_reading(const CanFrame& frame) const {
  const bool is_counted =
      array_.part.kind == CanPlace::Kind::identifier || array_.row.kind == CanPlace::Kind::identifier;
  if (!is_counted && frame.id != array_.id) return std::nullopt;
  if (frame.data.size() <= array_.first ||
      !std::equal(
          array_.begins.begin(), array_.begins.end(), frame.data.begin(),
          frame.data.begin() + static_cast<std::ptrdiff_t>(std::min(array_.begins.size(), frame.data.size())))) {
    return std::nullopt;
  }
  const auto part = number_at(array_.part, frame, array_.id);
  const auto row = number_at(array_.row, frame, array_.id);
  const auto col = number_at(array_.col, frame, array_.id);
  if (!part || !row || !col || *col >= array_.shape.cols) return std::nullopt;
  const std::size_t begin = *part * array_.each + *row * array_.shape.cols + *col;
  return begin < counts_.size() ? std::optional(begin) : std::nullopt;
}

/// How many a frame holds: a part, a row, or all that stand in it. 0 where it is cut short.
std::size_t CanAssembly::readings_in(const CanFrame& frame, std::size_t begin) const {
  const std::size_t held = (frame.data.size() - array_.first) / size_of(array_.value);
  const std::size_t left = counts_.size() - begin;
  const bool is_part = array_.part.kind != CanPlace::Kind::nowhere;
  const bool is_row = array_.row.kind != CanPlace::Kind::nowhere && array_.col.kind == CanPlace::Kind::nowhere;
  if (array_.col.kind != CanPlace::Kind::nowhere) {
    return std::min({held, left, array_.each == 0 ? left : array_.each});
  }
  const std::size_t all = is_row ? array_.shape.cols : left;
  const std::size_t wanted = is_part || array_.each != 0 ? std::min(array_.each, left) : all;
  return held >= wanted ? wanted : 0;
}

std::size_t CanAssembly::taxel_of(std::size_t reading) const {
  const auto& [rows, cols] = array_.shape;
  std::size_t row = array_.by_columns ? reading % rows : reading / cols;
  const std::size_t col = array_.by_columns ? reading / rows : reading % cols;
  if (array_.last_row_first) row = rows - 1 - row;
  return row * cols + col;
}

CanAssembly::Taken CanAssembly::take(const CanFrame& frame) {
  const std::optional<std::size_t> begin = first_reading(frame);
  const std::size_t count = begin ? readings_in(frame, *begin) : 0;
  if (count == 0) return Taken::nothing;
  const bool begins_again = *begin == 0 && last_end_ == counts_.size() && missing_ + count < counts_.size();
  if (has_come_[*begin] || begins_again) {
    ++incomplete_;
    has_come_.assign(has_come_.size(), false);
    missing_ = counts_.size();
  }
  last_end_ = *begin + count;
  const std::size_t size = size_of(array_.value);
  for (std::size_t k = 0; k < count; ++k) {
    const double number = number_of(array_.value, Bytes(frame.data).subspan(array_.first + k * size, size));
    counts_[taxel_of(*begin + k)] = static_cast<float>(array_.scale * number + array_.offset);
    if (!has_come_[*begin + k]) --missing_;
    has_come_[*begin + k] = true;
  }
  if (missing_ > 0) return Taken::part;
  whole_ = counts_;
  has_come_.assign(has_come_.size(), false);
  missing_ = counts_.size();
  return Taken::frame;
}

}  // namespace dermis::live::buses
