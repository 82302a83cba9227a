// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/report/png.hpp"

#include <zlib.h>

#include <array>
#include <cassert>
#include <string_view>

namespace dermis::report {
namespace {

constexpr std::string_view kMagic = "\x89PNG\r\n\x1a\n";
[[maybe_unused]] constexpr std::size_t kMostPixels = std::size_t{1} << 24U;
constexpr std::size_t kBytesPerPixel = 3;

void append_u32(std::string& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift & 0xFFU);
}

void append_u16(std::string& bytes, unsigned value) {
  bytes += static_cast<char>(value >> 8U & 0xFFU);
  bytes += static_cast<char>(value & 0xFFU);
}

std::string chunk(std::string_view type, std::string_view data) {
  std::string body = std::string(type) + std::string(data);
  std::string bytes;
  append_u32(bytes, static_cast<std::uint32_t>(data.size()));
  const auto crc = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  bytes += body;
  append_u32(bytes, static_cast<std::uint32_t>(crc));
  return bytes;
}

std::string header(std::size_t width, std::size_t height) {
  std::string data;
  append_u32(data, static_cast<std::uint32_t>(width));
  append_u32(data, static_cast<std::uint32_t>(height));
  data += std::string("\x08\x02\0\0\0", 5);  // 8 bits, RGB, deflate, filters, not interlaced
  return std::string(kMagic) + chunk("IHDR", data);
}

/// Each line as its difference from the one above: squares become zeros.
std::string filtered(const Pixels& pixels) {
  constexpr char kUp = 2;
  const std::size_t stride = kBytesPerPixel * pixels.width;
  std::string lines;
  lines.reserve((stride + 1) * pixels.height);
  for (std::size_t y = 0; y < pixels.height; ++y) {
    lines += kUp;
    for (std::size_t i = y * stride; i < (y + 1) * stride; ++i) {
      const unsigned above = y == 0 ? 0U : pixels.rgb[i - stride];
      lines += static_cast<char>(static_cast<std::uint8_t>(pixels.rgb[i] - above));
    }
  }
  return lines;
}

std::string compressed(const Pixels& pixels) {
  assert(pixels.width >= 1 && pixels.height >= 1 && pixels.width <= kMostPixels / pixels.height);
  assert(pixels.rgb.size() == kBytesPerPixel * pixels.width * pixels.height);
  const std::string lines = filtered(pixels);
  std::string out(::compressBound(lines.size()), '\0');
  uLongf size = out.size();
  [[maybe_unused]] const int result =
      ::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(lines.data()),
                  lines.size(), Z_DEFAULT_COMPRESSION);
  assert(result == Z_OK);
  out.resize(size);
  return out;
}

}  // namespace

std::string png(const Pixels& pixels) {
  return header(pixels.width, pixels.height) + chunk("IDAT", compressed(pixels)) + chunk("IEND", "");
}

void AnimatedPng::add(const Pixels& pixels, unsigned milliseconds) {
  if (count_ == 0) {
    width_ = pixels.width;
    height_ = pixels.height;
  }
  assert(pixels.width == width_ && pixels.height == height_ && milliseconds >= 1 && milliseconds <= 65535);
  std::string control;
  append_u32(control, sequence_++);
  append_u32(control, static_cast<std::uint32_t>(width_));
  append_u32(control, static_cast<std::uint32_t>(height_));
  append_u32(control, 0);  // left
  append_u32(control, 0);  // top
  append_u16(control, milliseconds);
  append_u16(control, 1000);          // of a second
  control += std::string("\0\0", 2);  // stays; replaces what was there
  pictures_ += chunk("fcTL", control);
  std::string data;
  if (count_ > 0) append_u32(data, sequence_++);
  data += compressed(pixels);
  pictures_ += chunk(count_ == 0 ? "IDAT" : "fdAT", data);
  ++count_;
}

std::string AnimatedPng::take() && {
  assert(count_ >= 1);
  std::string control;
  append_u32(control, count_);
  append_u32(control, 0);  // for ever
  return header(width_, height_) + chunk("acTL", control) + pictures_ + chunk("IEND", "");
}

}  // namespace dermis::report
