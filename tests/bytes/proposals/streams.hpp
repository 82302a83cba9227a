// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"

/// Streams as firmware prints them, of a press that wanders over an array.
namespace dermis::bytes::proposals::test {

using Frame = std::vector<int>;
using Bytes = std::vector<std::uint8_t>;

inline constexpr std::size_t kFrames = 30;

/// Counts of a press that wanders and comes again, over a little noise; the same for the same seed.
inline std::vector<Frame> pressed_frames(const FrameShape& shape, double peak = 800.0, std::uint32_t seed = 1) {
  std::vector<Frame> frames;
  std::uint32_t state = seed;
  const auto rows = static_cast<double>(shape.rows);
  const auto cols = static_cast<double>(shape.cols);
  const double width = std::max(rows, cols) / 6.0;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const auto phase = static_cast<double>(k);
    const double row = rows / 2.0 + rows / 4.0 * std::sin(phase / 5.0 + seed);
    const double col = cols / 2.0 + cols / 4.0 * std::cos(phase / 7.0 + seed);
    Frame& frame = frames.emplace_back();
    for (std::size_t i = 0; i < shape.taxel_count(); ++i) {
      const std::size_t taxel_row = i / shape.cols;
      const double down = static_cast<double>(taxel_row) - row;
      const double right = static_cast<double>(i % shape.cols) - col;
      const double press = peak * std::max(0.0, std::sin(phase / 6.0)) *
                           std::exp(-(down * down + right * right) / (2.0 * width * width));
      state = 1664525U * state + 1013904223U;
      frame.push_back(static_cast<int>(press) + static_cast<int>(state >> 16U) % 6);
    }
  }
  return frames;
}

inline std::string joined(const Frame& frame, const std::string& separator, const std::string& format = "%d") {
  std::string text;
  for (const int value : frame) {
    char number[32];
    std::snprintf(number, sizeof number, format.c_str(), value);
    text += (text.empty() ? "" : separator) + number;
  }
  return text;
}

inline Frame row_of(const Frame& frame, std::size_t row, std::size_t cols) {
  const auto begin = frame.begin() + static_cast<std::ptrdiff_t>(row * cols);
  return {begin, begin + static_cast<std::ptrdiff_t>(cols)};
}

/// The low byte first, or the high one.
inline void add_number(Bytes& bytes, std::uint64_t number, std::size_t size, bool is_big_endian = false) {
  for (std::size_t k = 0; k < size; ++k) {
    bytes.push_back(static_cast<std::uint8_t>(number >> 8U * (is_big_endian ? size - 1 - k : k)));
  }
}

inline void add_readings(Bytes& bytes, const Frame& frame, std::size_t size = 2, bool is_big_endian = false) {
  for (const int value : frame) add_number(bytes, static_cast<std::uint64_t>(value), size, is_big_endian);
}

/// Packed without gaps, the highest bit first.
inline void add_packed(Bytes& bytes, const Frame& frame, unsigned bits) {
  std::uint64_t waiting = 0;
  unsigned count = 0;
  for (const int value : frame) {
    waiting = waiting << bits | static_cast<std::uint64_t>(value);
    for (count += bits; count >= 8; count -= 8) bytes.push_back(static_cast<std::uint8_t>(waiting >> (count - 8)));
  }
  if (count > 0) bytes.push_back(static_cast<std::uint8_t>(waiting << (8 - count)));
}

inline std::uint16_t crc16_ccitt(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= std::uint32_t{byte} << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = ((crc & 0x8000U) != 0 ? crc << 1U ^ 0x1021U : crc << 1U) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

inline std::uint16_t crc16_modbus(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

inline Bytes with_cobs(const Bytes& bytes) {
  Bytes result;
  Bytes block;
  const auto end_block = [&](std::size_t code) {
    result.push_back(static_cast<std::uint8_t>(code));
    result.insert(result.end(), block.begin(), block.end());
    block.clear();
  };
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) block.push_back(byte);
    if (byte == 0 || block.size() == 254) end_block(block.size() + 1);
  }
  end_block(block.size() + 1);
  result.push_back(0);
  return result;
}

inline Bytes with_slip(const Bytes& bytes) {
  Bytes result;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0xC0 || byte == 0xDB) result.push_back(0xDB);
    result.push_back(byte == 0xC0 ? 0xDC : byte == 0xDB ? 0xDD : byte);
  }
  result.push_back(0xC0);
  return result;
}

}  // namespace dermis::bytes::proposals::test
