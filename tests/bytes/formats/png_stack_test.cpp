// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <cstdint>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::formats {
namespace {

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFFU);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + checked + big_endian(static_cast<std::uint32_t>(crc));
}

/// A picture by hand, after the specification; `rows` are bytes as they stand in it.
std::string png(std::uint32_t width, const std::vector<std::string>& rows, char depth = 8, char colour = 0) {
  std::string raw;
  for (const std::string& row : rows) raw += '\0' + row;
  std::string packed(raw.size() + 100, '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size());
  packed.resize(size);
  const std::string header = big_endian(width) + big_endian(static_cast<std::uint32_t>(rows.size()));
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", header + std::string{depth, colour, 0, 0, 0}) + chunk("IDAT", packed) +
         chunk("IEND", "");
}

std::vector<std::uint16_t> levels(const std::string& bytes) {
  const auto picture = read_grey_png(bytes, "p.png");
  if (!picture) ADD_FAILURE() << picture.error().message;
  return picture ? picture->levels : std::vector<std::uint16_t>{};
}

std::string error(const std::string& bytes) {
  const auto picture = read_grey_png(bytes, "p.png");
  return picture ? "no error" : picture.error().message;
}

TEST(PngStack, has_the_levels_as_they_stand_in_the_picture) {
  EXPECT_EQ(levels(png(3, {"abc", "de\xFF"})), (std::vector<std::uint16_t>{97, 98, 99, 100, 101, 255}));
  EXPECT_EQ(levels(png(2, {std::string("\x01\x02\xFF\xFE", 4)}, 16)), (std::vector<std::uint16_t>{258, 65534}));
  EXPECT_EQ(levels(png(4, {"\x1B"}, 2)), (std::vector<std::uint16_t>{0, 1, 2, 3}));
  EXPECT_EQ(levels(png(2, {"a\x10z\x20"}, 8, 4)), (std::vector<std::uint16_t>{'a', 'z'})) << "without transparency";
  const auto picture = read_grey_png(png(3, {"abc", "def"}), "p.png");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->shape, (FrameShape{2, 3}));
}

TEST(PngStack, says_what_is_wrong_with_a_picture) {
  EXPECT_EQ(error(png(1, {"abc"}, 8, 2)), "p.png: is coloured; save it as grey levels");
  EXPECT_EQ(error(""), "p.png: is cut short");
  const std::string whole = png(3, {"abc", "def"});
  EXPECT_EQ(error(whole.substr(0, whole.size() - 20)), "p.png: is cut short");
  EXPECT_NE(error("GIF89a........................"), "no error");
  EXPECT_NE(error(png(1025, {std::string(1025, 'a')})), "no error");
}

TEST(PngStack, leaves_out_texts_whatever_memory_they_would_take) {
  const std::string text(std::size_t{1} << 22U, 'x');
  std::string packed(text.size(), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()), text.size());
  const std::string one = chunk("zTXt", std::string("k\0\0", 3) + packed.substr(0, size));
  std::string all;
  for (int i = 0; i < 300; ++i) all += one;
  constexpr std::size_t kAfterHeader = 33;
  const std::string bytes = png(3, {"abc", "def"}).insert(kAfterHeader, all);
  const auto most_memory_kib = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before = most_memory_kib();
  EXPECT_EQ(levels(bytes), (std::vector<std::uint16_t>{'a', 'b', 'c', 'd', 'e', 'f'}));
  EXPECT_LT(most_memory_kib() - before, 50'000) << "of 1.2 GB of text";
}

TEST(PngStack, of_a_folder_come_in_the_order_of_their_numbers) {
  const support::TemporaryFolder folder;
  for (const int number : {10, 9, 1, 100}) {
    const std::string name = "frame" + std::to_string(number) + ".png";
    support::write_bytes(folder.file(name), png(1, {std::string(1, static_cast<char>(number))}));
  }
  support::write_bytes(folder.file("notes.txt"), "not a picture");
  const auto source = open_png_stack(folder.file(""), {.rate_hz = 4.0});
  ASSERT_TRUE(source) << source.error().message;
  const auto frames = support::read_all(**source);
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 4U);
  std::vector<float> firsts;
  for (const RawFrame& frame : *frames) firsts.push_back(frame.counts[0]);
  EXPECT_EQ(firsts, (std::vector<float>{1, 9, 10, 100}));
  EXPECT_EQ(frames->back().time, std::chrono::milliseconds(750));
}

TEST(PngStack, names_the_picture_that_is_wrong) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("");
  EXPECT_EQ(open_png_stack(path, {.rate_hz = 4.0}).error().message, path + ": is a folder without .png files");
  support::write_bytes(folder.file("a1.png"), png(2, {"ab"}));
  support::write_bytes(folder.file("a2.png"), png(3, {"abc"}));
  const auto source = open_png_stack(path, {.rate_hz = 4.0});
  ASSERT_TRUE(source);
  const auto frames = support::read_all(**source);
  ASSERT_FALSE(frames);
  EXPECT_EQ(frames.error().message, folder.file("a2.png") + ": has 1x3 taxels, the array is 1x2");
  const auto one = open_png_stack(folder.file("a2.png"), {.rate_hz = 4.0});
  ASSERT_TRUE(one);
  EXPECT_EQ(support::read_all(**one)->size(), 1U);
}

TEST(PngStack, gives_a_value_or_a_one_line_error_for_mutations) {
  support::expect_value_or_one_line_error(png(3, {"abc", "def"}), 20000,
                                          [](const std::string& bytes) { return read_grey_png(bytes, "mutated"); });
}

}  // namespace
}  // namespace dermis::bytes::formats
