// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/report/png.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <utility>

namespace dermis::report {
namespace {

Pixels gradient(std::size_t width, std::size_t height, unsigned shift) {
  Pixels pixels{width, height, {}};
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      for (const std::size_t part : {7 * x, 5 * y, x * y + shift}) {
        pixels.rgb.push_back(static_cast<std::uint8_t>(part & 0xFFU));
      }
    }
  }
  return pixels;
}

std::uint32_t u32(const std::string& bytes, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[place + i]);
  return value;
}

/// Type and data of each chunk; their checksums are verified.
std::vector<std::pair<std::string, std::string>> chunks_of(const std::string& file) {
  EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::vector<std::pair<std::string, std::string>> chunks;
  for (std::size_t place = 8; place < file.size();) {
    const std::size_t size = u32(file, place);
    const std::string body = file.substr(place + 4, size + 4);
    EXPECT_EQ(::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())),
              u32(file, place + 8 + size));
    chunks.emplace_back(body.substr(0, 4), body.substr(4));
    place += size + 12;
  }
  return chunks;
}

/// The pixels behind zlib and the filters.
std::vector<std::uint8_t> pixels_of(const std::string& compressed, std::size_t width, std::size_t height) {
  const std::size_t stride = 3 * width;
  std::vector<std::uint8_t> lines((stride + 1) * height);
  uLongf size = lines.size();
  EXPECT_EQ(::uncompress(lines.data(), &size, reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
            Z_OK);
  EXPECT_EQ(size, lines.size());
  std::vector<std::uint8_t> rgb;
  for (std::size_t y = 0; y < height; ++y) {
    EXPECT_EQ(lines[y * (stride + 1)], 2) << "differences from the line above";
    for (std::size_t i = 0; i < stride; ++i) {
      const unsigned above = y == 0 ? 0U : rgb[(y - 1) * stride + i];
      rgb.push_back(static_cast<std::uint8_t>(lines[y * (stride + 1) + 1 + i] + above));
    }
  }
  return rgb;
}

TEST(Png, holds_every_pixel) {
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{1, 1}, {7, 3}, {200, 150}}) {
    const Pixels pixels = gradient(width, height, 0);
    const auto chunks = chunks_of(png(pixels));
    ASSERT_EQ(chunks.size(), 3U);
    EXPECT_EQ(chunks[0].first, "IHDR");
    EXPECT_EQ(u32(chunks[0].second, 0), width);
    EXPECT_EQ(u32(chunks[0].second, 4), height);
    EXPECT_EQ(chunks[0].second.substr(8), std::string("\x08\x02\0\0\0", 5));
    EXPECT_EQ(chunks[1].first, "IDAT");
    EXPECT_EQ(pixels_of(chunks[1].second, width, height), pixels.rgb);
    EXPECT_EQ(chunks[2].first, "IEND");
  }
}

TEST(AnimatedPng, holds_every_picture_in_order) {
  AnimatedPng moving;
  for (unsigned i = 0; i < 3; ++i) moving.add(gradient(20, 10, 50 * i), 40);
  EXPECT_EQ(moving.count(), 3U);
  const auto chunks = chunks_of(std::move(moving).take());
  std::string types;
  for (const auto& [type, data] : chunks) types += type + " ";
  EXPECT_EQ(types, "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  EXPECT_EQ(u32(chunks[1].second, 0), 3U);
  EXPECT_EQ(u32(chunks[1].second, 4), 0U) << "for ever";
  std::uint32_t sequence = 0;
  unsigned picture = 0;
  for (const auto& [type, data] : chunks) {
    if (type == "fcTL") {
      EXPECT_EQ(u32(data, 0), sequence++);
      EXPECT_EQ(u32(data, 4), 20U);
      EXPECT_EQ(u32(data, 8), 10U);
      EXPECT_EQ(data.substr(20), std::string("\0\x28\x03\xe8\0\0", 6)) << "40/1000 s, replaces what was there";
    } else if (type == "IDAT" || type == "fdAT") {
      if (type == "fdAT") {
        EXPECT_EQ(u32(data, 0), sequence++);
      }
      EXPECT_EQ(pixels_of(type == "fdAT" ? data.substr(4) : data, 20, 10), gradient(20, 10, 50 * picture++).rgb);
    }
  }
  EXPECT_EQ(picture, 3U);
}

}  // namespace
}  // namespace dermis::report
