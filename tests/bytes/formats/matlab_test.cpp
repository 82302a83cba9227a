// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/matlab.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "bytes/formats/imported.hpp"

namespace dermis::bytes::formats {
namespace {

using Sizes = std::vector<std::uint32_t>;

/// Bytes of numbers in the order of a machine.
template <typename T>
std::string bytes_of(const std::vector<T>& numbers, bool is_big_endian = false) {
  std::string bytes;
  for (const T number : numbers) {
    std::string item(sizeof(T), '\0');
    std::memcpy(item.data(), &number, sizeof(T));
    if (is_big_endian) std::reverse(item.begin(), item.end());
    bytes += item;
  }
  return bytes;
}

/// A file of version 5 by hand, after its specification.
class Version5 {
 public:
  explicit Version5(bool is_big_endian = false) : is_big_endian_(is_big_endian) {}

  template <typename T>
  Version5& add(const std::string& name, const Sizes& sizes, const std::vector<T>& values, bool is_compressed = false) {
    const std::string matrix = element(6, words({kind_of(T{}), 0})) + element(5, words(sizes)) + element(1, name) +
                               element(type_of(T{}), bytes_of(values, is_big_endian_));
    const std::string whole = words({14, static_cast<std::uint32_t>(matrix.size())}) + matrix;
    files_ += is_compressed ? packed(whole) : whole;
    return *this;
  }

  [[nodiscard]] std::string bytes() const {
    std::string header = "MATLAB 5.0 MAT-file, by hand";
    header.resize(124, ' ');
    return header + (is_big_endian_ ? std::string("\1\0MI", 4) : std::string("\0\1IM", 4)) + files_;
  }

 private:
  static std::uint32_t kind_of(double) { return 6; }
  static std::uint32_t kind_of(std::uint16_t) { return 11; }
  static std::uint32_t type_of(double) { return 9; }
  static std::uint32_t type_of(std::uint16_t) { return 4; }

  [[nodiscard]] std::string words(const Sizes& numbers) const { return bytes_of(numbers, is_big_endian_); }

  [[nodiscard]] std::string element(std::uint32_t type, std::string content) const {
    const std::string tag = words({type, static_cast<std::uint32_t>(content.size())});
    content.resize((content.size() + 7) / 8 * 8);
    return tag + content;
  }

  [[nodiscard]] std::string packed(const std::string& whole) const {
    std::string packed(compressBound(whole.size()), '\0');
    uLongf size = packed.size();
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(whole.data()),
                       whole.size()),
              Z_OK);
    packed.resize(size);
    return words({15, static_cast<std::uint32_t>(size)}) + packed;
  }

  bool is_big_endian_;
  std::string files_;
};

std::string version_4(const std::string& name, std::uint32_t rows, std::uint32_t cols,
                      const std::vector<double>& values) {
  const auto name_bytes = static_cast<std::uint32_t>(name.size() + 1);
  return bytes_of<std::uint32_t>({0, rows, cols, 0, name_bytes}) + name + '\0' + bytes_of(values);
}

/// Readings of frame, row and column.
double reading(std::size_t frame, std::size_t row, std::size_t col) {
  return static_cast<double>(100 * frame + 10 * row + col);
}

/// Four frames of 2 x 3 taxels, and their values in the order of MATLAB where the second size counts the frames.
const Frames kFrames = {{0, 1, 2, 10, 11, 12},
                        {100, 101, 102, 110, 111, 112},
                        {200, 201, 202, 210, 211, 212},
                        {300, 301, 302, 310, 311, 312}};
const std::vector<double> kTimeInTheMiddle = [] {
  std::vector<double> values;
  for (std::size_t col = 0; col < 3; ++col) {
    for (std::size_t frame = 0; frame < 4; ++frame) {
      for (std::size_t row = 0; row < 2; ++row) values.push_back(reading(frame, row, col));
    }
  }
  return values;
}();
const std::vector<double> kFs = {50.0};

Result<std::unique_ptr<FrameSource>> open(std::unique_ptr<std::istream> in, const std::string& name,
                                          const ImportOptions& options) {
  return open_matlab(std::move(in), name, options);
}

TEST(Matlab, reads_frames_that_the_second_size_counts) {
  Importer importer(open, {.shape = FrameShape{2, 3}});
  for (const bool is_big_endian : {false, true}) {
    for (const bool is_compressed : {false, true}) {
      const std::string bytes = Version5(is_big_endian)
                                    .add("data", {2, 4, 3}, kTimeInTheMiddle, is_compressed)
                                    .add("fs", {1, 1}, kFs)
                                    .bytes();
      EXPECT_EQ(importer.counts(bytes), kFrames) << is_big_endian << is_compressed;
      EXPECT_EQ(importer.seconds(bytes), (std::vector<double>{0.0, 0.02, 0.04, 0.06}));
    }
  }
}

TEST(Matlab, reads_whole_numbers_and_frames_that_another_size_counts) {
  std::vector<std::uint16_t> last;
  std::vector<std::uint16_t> first;
  for (std::size_t frame = 0; frame < 4; ++frame) {
    for (std::size_t k = 0; k < 6; ++k) last.push_back(static_cast<std::uint16_t>(reading(frame, k % 2, k / 2)));
  }
  for (std::size_t k = 0; k < 24; ++k) first.push_back(static_cast<std::uint16_t>(reading(k % 4, k / 4 % 2, k / 8)));
  Importer importer(open, {.shape = FrameShape{2, 3}, .rate_hz = 10.0});
  EXPECT_EQ(importer.counts(Version5().add("p", {2, 3, 4}, last).bytes()), kFrames);
  EXPECT_EQ(importer.counts(Version5().add("p", {4, 2, 3}, first).bytes()), kFrames);
}

TEST(Matlab, reads_version_4_row_by_row) {
  std::vector<double> frames_by_taxels;
  std::vector<double> taxels_by_frames;
  for (std::size_t k = 0; k < 24; ++k) {
    frames_by_taxels.push_back(reading(k % 4, k / 12, k / 4 % 3));
    taxels_by_frames.push_back(reading(k / 6, k % 6 / 3, k % 3));
  }
  Importer importer(open, {.shape = FrameShape{2, 3}});
  EXPECT_EQ(importer.counts(version_4("data", 4, 6, frames_by_taxels) + version_4("fs", 1, 1, kFs)), kFrames);
  EXPECT_EQ(importer.counts(version_4("data", 6, 4, taxels_by_frames) + version_4("fs", 1, 1, kFs)), kFrames);
}

TEST(Matlab, takes_times_of_the_file) {
  Importer importer(open);
  const std::vector<double> times = {1.5, 1.75};
  const std::string bytes =
      Version5().add("data", {3, 2, 3}, std::vector<double>(18)).add("time_s", {2, 1}, times).bytes();
  EXPECT_EQ(importer.seconds(bytes), times);  // and their number tells which size counts the frames
  EXPECT_EQ(importer.shape(), (FrameShape{3, 3}));
  EXPECT_EQ(Importer(open, {.rate_hz = 4.0}).seconds(bytes), (std::vector<double>{0.0, 0.25}));
}

/// A press that moves slowly over 4 x 5 taxels, in the order of MATLAB; the second size counts 60 frames.
std::vector<double> slow_press() {
  std::vector<double> values;
  for (int col = 0; col < 5; ++col) {
    for (int frame = 0; frame < 60; ++frame) {
      for (int row = 0; row < 4; ++row) values.push_back(row * 40 % 70 + col * 30 % 50 + frame);
    }
  }
  return values;
}

TEST(Matlab, finds_the_frames_by_how_little_readings_change) {
  Importer importer(open, {.rate_hz = 10.0});
  EXPECT_EQ(importer.counts(Version5().add("data", {4, 60, 5}, slow_press()).bytes()).size(), 60U);
  EXPECT_EQ(importer.shape(), (FrameShape{4, 5}));
}

TEST(Matlab, asks_where_it_is_not_clear) {
  Importer importer(open, {.rate_hz = 10.0});
  EXPECT_EQ(importer.error(Version5().add("data", {2, 2, 3}, std::vector<double>(12)).bytes()),
            "f: variable 'data' is 2 x 2 x 3, and it is not clear which of these counts the frames: rows and cols must "
            "be given");
  EXPECT_EQ(
      importer.error(Version5().add("data", {2, 6}, std::vector<double>(12)).bytes()),
      "f: no variable has three dimensions, frames, rows and cols; of two, rows and cols must be given: 'data' (2 "
      "x 6)");
}

TEST(Matlab, reads_the_variable_that_is_named) {
  const std::string bytes = Version5()
                                .add("left", {4, 60, 5}, slow_press())
                                .add("right", {4, 60, 5}, slow_press())
                                .add("fs", {1, 1}, kFs)
                                .bytes();
  EXPECT_EQ(Importer(open, {.array = "right"}).counts(bytes).size(), 60U);
  EXPECT_EQ(Importer(open).error(bytes),
            "f: name the variable, as 'f#left'; it has: 'left' (4 x 60 x 5), 'right' (4 x 60 x 5), 'fs' (1 x 1)");
  EXPECT_EQ(Importer(open, {.array = "foot"}).error(bytes),
            "f: has no variable 'foot'; it has: 'left' (4 x 60 x 5), 'right' (4 x 60 x 5), 'fs' (1 x 1)");
  const std::string usual = Version5().add("data", {4, 60, 5}, slow_press()).add("b", {4, 60, 5}, slow_press()).bytes();
  EXPECT_EQ(Importer(open, {.rate_hz = 1.0}).counts(usual).size(), 60U);
}

TEST(Matlab, names_what_is_wrong) {
  const std::string whole = Version5().add("data", {2, 4, 3}, kTimeInTheMiddle).bytes();
  Importer importer(open, {.shape = FrameShape{2, 3}, .rate_hz = 1.0});
  EXPECT_EQ(importer.error(""), "f: holds no variable of numbers, or is damaged");
  EXPECT_EQ(importer.error("PK"), "f: is cut off or damaged, or no file of MATLAB");
  for (const std::size_t size : {std::size_t{130}, std::size_t{200}, whole.size() - 1}) {
    EXPECT_EQ(importer.error(whole.substr(0, size)), "f: is cut off or damaged, or no file of MATLAB") << size;
  }
  EXPECT_EQ(Importer(open, {.shape = FrameShape{3, 3}, .rate_hz = 1.0}).error(whole),
            "f: variable 'data' is 2 x 4 x 3, the array is 3x3");
  EXPECT_EQ(Importer(open, {.shape = FrameShape{2, 3}}).error(whole),
            "f: has no times, neither a variable 'time_s' nor a rate 'fs': give a rate, when it is converted or as "
            "'file:f?rate=HZ'");
  EXPECT_EQ(importer.error(Version5().add("data", {2, 1, 3}, std::vector<double>(6, 1e9)).bytes()),
            "f: variable 'data' has values beyond 16777216, which cannot be held exactly");
}

TEST(Matlab, tells_compressed_values_that_are_damaged) {
  std::string bytes = Version5().add("data", {4, 60, 5}, slow_press(), true).bytes();
  bytes[bytes.size() - 1] ^= 1;  // the checksum
  EXPECT_EQ(Importer(open, {.rate_hz = 1.0}).error(bytes), "f: is cut off or damaged, or no file of MATLAB");
}

TEST(Matlab, tells_files_that_cannot_be_read) {
  const std::string whole = Version5().add("data", {2, 4, 3}, kTimeInTheMiddle).bytes();
  Importer importer(open, {.shape = FrameShape{2, 3}, .rate_hz = 1.0});
  EXPECT_EQ(importer.fault(whole, BadFile::Fault::seek).message, "f: cannot be read from a pipe; save it as a file");
}

TEST(Matlab, survives_damage) {
  Importer importer(open, {.shape = FrameShape{2, 3}, .rate_hz = 1.0});
  for (const bool is_compressed : {false, true}) {
    importer.expect_value_or_one_line_error(
        Version5().add("data", {2, 4, 3}, kTimeInTheMiddle, is_compressed).add("fs", {1, 1}, kFs).bytes(), 2000);
  }
  importer.expect_value_or_one_line_error(version_4("data", 2, 6, std::vector<double>(12)), 2000);
}

}  // namespace
}  // namespace dermis::bytes::formats
