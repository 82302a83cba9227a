// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/npy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "support/allocation_guard.hpp"
#include "support/full_disk.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

/// A file by hand, after the specification of the format and not with the writer.
std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string file = "\x93NUMPY";
  file += {version, 0, static_cast<char>(dictionary.size()), 0};
  if (version > 1) file += {0, 0};
  return file + dictionary + data;
}

std::string dictionary(const std::string& type, const std::string& shape, const std::string& order = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

Result<std::vector<RawFrame>> parse(const std::string& bytes, std::optional<FrameShape> shape = {},
                                    const std::string& name = "f.npy") {
  const auto reader = NpyReader::open(std::make_unique<std::istringstream>(bytes), name, {100.0, shape});
  if (!reader) return reader.error();
  return support::read_all(**reader);
}

std::vector<float> counts_of(const std::string& bytes) {
  const auto frames = parse(bytes);
  if (!frames) ADD_FAILURE() << frames.error().message;
  if (!frames || frames->size() != 1) return {};
  return frames->front().counts;
}

std::string error_of(const std::string& bytes, std::optional<FrameShape> shape = {}) {
  const auto frames = parse(bytes, shape);
  if (frames) return "no error";
  EXPECT_EQ(frames.error().kind, ErrorKind::bad_input);
  return frames.error().message;
}

template <typename T>
std::string bytes_of(std::initializer_list<T> values, bool is_big_endian = false) {
  std::string bytes;
  for (const T value : values) {
    std::string item(reinterpret_cast<const char*>(&value), sizeof(T));
    if (is_big_endian) std::reverse(item.begin(), item.end());
    bytes += item;
  }
  return bytes;
}

template <typename T>
void expect_type(const std::string& type, std::initializer_list<T> values) {
  SCOPED_TRACE(type);
  const std::vector<float> expected(values.begin(), values.end());
  EXPECT_EQ(counts_of(npy(dictionary("<" + type, "(1, 1, 2)"), bytes_of(values))), expected);
  EXPECT_EQ(counts_of(npy(dictionary(">" + type, "(1, 1, 2)"), bytes_of(values, true))), expected);
}

TEST(Npy, allocates_nothing_after_the_first_frame_and_leaves_nothing_of_another) {
  const std::string bytes = npy(dictionary("<u2", "(100, 8, 8)"), std::string(std::size_t{12800}, 'a'));
  const auto reader = NpyReader::open(std::make_unique<std::istringstream>(bytes), "f.npy", {100.0, {}});
  ASSERT_TRUE(reader);
  RawFrame frame;
  frame.temperature_celsius = 20.0;
  frame.supply_v = 3.3;
  frame.acquisition.sequence = 7;
  ASSERT_TRUE((*reader)->next(frame));
  EXPECT_FALSE(frame.temperature_celsius);
  EXPECT_FALSE(frame.supply_v);
  EXPECT_EQ(frame.acquisition, Acquisition{});
  const support::AllocationGuard guard;
  for (int k = 1; k < 100; ++k) ASSERT_TRUE(*(*reader)->next(frame));
  if (support::kAllocationsAreCounted) {
    EXPECT_EQ(guard.count(), 0U);
  }
}

TEST(Npy, reads_every_type_in_both_byte_orders) {
  expect_type<std::uint8_t>("u1", {7, 255});
  expect_type<std::int8_t>("i1", {-128, 127});
  expect_type<std::uint16_t>("u2", {258, 65535});
  expect_type<std::int16_t>("i2", {-32768, 258});
  expect_type<std::uint32_t>("u4", {1, 16777216});
  expect_type<std::int32_t>("i4", {-16777216, 66051});
  expect_type<std::uint64_t>("u8", {1, 16777216});
  expect_type<std::int64_t>("i8", {-16777216, 66051});
  expect_type<float>("f4", {1.5F, -0.1F});
  expect_type<double>("f8", {1.5, 4095.25});
  EXPECT_EQ(counts_of(npy(dictionary("|u1", "(1,1,2)"), "\x01\xFF")), (std::vector<float>{1, 255}));
}

TEST(Npy, reads_every_version_and_style_of_header) {
  const std::string data = bytes_of<std::uint16_t>({1, 2});
  for (const char version : {'\1', '\2', '\3'}) {
    EXPECT_EQ(counts_of(npy(dictionary("<u2", "(1, 1, 2)"), data, version)), (std::vector<float>{1, 2}));
  }
  for (const std::string header : {"{\"shape\":(1,1,2),\"descr\":\"<u2\",\"fortran_order\":False}",
                                   " { 'fortran_order' :False , 'descr' : '<u2' ,'shape' : ( 1L , 1 , 2 , ) , }  \n"}) {
    EXPECT_EQ(counts_of(npy(header, data)), (std::vector<float>{1, 2})) << header;
  }
}

TEST(Npy, spaces_frames_by_the_rate) {
  const auto reader = NpyReader::open(std::make_unique<std::istringstream>(npy(dictionary("|u1", "(4, 1, 1)"), "abcd")),
                                      "f.npy", {30.0, {}});
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader)->shape(), (FrameShape{1, 1}));
  const auto frames = support::read_all(**reader);
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 4U);
  EXPECT_EQ(frames->at(0).time.count(), 0);
  EXPECT_EQ(frames->at(1).time.count(), 33'333'333);
  EXPECT_EQ(frames->at(3).time.count(), 100'000'000);
  EXPECT_EQ(frames->at(3).acquisition, Acquisition{});
}

TEST(Npy, in_fortran_order_is_read_as_numpy_reads_it) {
  const auto frames = parse(npy(dictionary("|u1", "(2, 1, 3)", "True"), "adbecf"));
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_EQ(frames->at(0).counts, (std::vector<float>{'a', 'b', 'c'}));
  EXPECT_EQ(frames->at(1).counts, (std::vector<float>{'d', 'e', 'f'}));
}

TEST(Npy, takes_the_axes_that_are_named) {
  const std::string file = npy(dictionary("|u1", "(2, 3, 4)"), "abcdefghijklmnopqrstuvwx");
  const auto reader = NpyReader::open(std::make_unique<std::istringstream>(file), "f.npy",
                                      {.rate_hz = 10.0, .axes = "rows, cols, frames"});
  ASSERT_TRUE(reader);
  const auto frames = support::read_all(**reader);
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 4U);
  EXPECT_EQ(frames->at(1).counts, (std::vector<float>{'b', 'f', 'j', 'n', 'r', 'v'}));
  EXPECT_EQ(
      error_of(npy(dictionary("|u1", "(2, 3, 40)"), std::string(240, 'a'))),
      "f.npy: is 2 x 3 x 40, which can be read in two ways: 2 frames of 3x40, as 'f.npy#[frames, rows, cols]', or "
      "40 frames of 2x3, as 'f.npy#[rows, cols, frames]'");
}

TEST(Npy, of_two_dimensions_needs_the_shape) {
  const std::string file = npy(dictionary("|u1", "(1, 6)"), "abcdef");
  const auto frames = parse(file, FrameShape{2, 3});
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->front().counts.size(), 6U);
  EXPECT_EQ(error_of(file), "f.npy: has frames of 6 numbers; say how many rows and cols");
  EXPECT_EQ(error_of(file, FrameShape{4, 2}), "f.npy: has frames of 6 numbers, the array is 4x2");
}

TEST(Npy, names_what_cannot_be_read) {
  EXPECT_EQ(error_of("time_s,r0c0\n"), "f.npy: is no .npy file; write it with numpy.save");
  EXPECT_EQ(error_of(""), "f.npy: is no .npy file; write it with numpy.save");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1, 1, 1)"), "ab", 4)),
            "f.npy: is of a version of .npy that is not known; known: 1.0 to 3.0");
  for (const std::string type : {"<c8", "|b1", "<f2", "|S5", "<U1", "<u3", "u2", "<M8[ns]"}) {
    EXPECT_EQ(error_of(npy(dictionary(type, "(1, 1, 1)"), "ab")),
              "f.npy: has elements of type '" + type +
                  "'; whole numbers of 8 to 64 bits and floats of 32 or 64 bits can be read: use astype");
  }
  EXPECT_EQ(
      error_of(npy(dictionary("|O", "(1, 1, 1)"), "ab")),
      "f.npy: holds objects of Python (a pickle), which may run any program when they are read; save numbers alone, "
      "by numpy.save of a plain array");
  EXPECT_EQ(error_of(npy("{'descr': [('a', '<u2')], 'fortran_order': False, 'shape': (1,), }", "ab")),
            "f.npy: has elements of several numbers; save the counts alone");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1,)"), "ab")),
            "f.npy: has 1 dimensions; frames x rows x cols is expected");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1, 0, 4)"), "ab")),
            "f.npy: has frames of 0x4 taxels; 1x1 to 1024x1024 can be read");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1, 1025, 1)"), "ab")),
            "f.npy: has frames of 1025x1 taxels; 1x1 to 1024x1024 can be read");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1, 1, 1)"), "ab"), FrameShape{2, 2}),
            "f.npy: has 1x1 taxels, the array is 2x2");
}

TEST(Npy, refuses_a_header_that_is_no_dictionary_of_the_three_keys) {
  for (const std::string header : {"", "{", "{}", "{'descr': '<u2'}", "{'descr': '<u2', 'fortran_order': False}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, 1)",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, 1)} x",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, 1), 'shape': (1, 1, 1)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, 1), 'x': 1}",
                                   "{'descr': '<u2', 'fortran_order': 0, 'shape': (1, 1, 1)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, -1)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1,, 1, 1)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1, 1, 99999999999999999999)}",
                                   "{'descr': '<u2', 'fortran_order': False, 'shape': (1,1,1,1,1,1,1,1,1)}",
                                   "{'de\\scr': '<u2', 'fortran_order': False, 'shape': (1, 1, 1)}",
                                   "{'descr': '<u2' 'fortran_order': False, 'shape': (1, 1, 1)}"}) {
    EXPECT_EQ(error_of(npy(header, "ab")), "f.npy: its header cannot be read; write the file with numpy.save")
        << header;
  }
  std::string long_header = npy("", "", 2);
  long_header[10] = 1;  // 64 KiB
  EXPECT_EQ(error_of(long_header), "f.npy: its header cannot be read; write the file with numpy.save");
}

TEST(Npy, names_the_frame_where_the_data_end_or_go_on) {
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(2, 1, 2)"), "abcdefg")),
            "f.npy: is cut short in frame 1 of 2; save it again");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(18446744073709551615, 1, 2)"), "abcd")),
            "f.npy: is cut short in frame 1 of 18446744073709551615; save it again");
  EXPECT_EQ(error_of(npy(dictionary("<u2", "(1, 1, 2)"), "abcde")),
            "f.npy: has bytes after its 1 frames; save it again");
}

TEST(Npy, names_a_count_that_a_float_cannot_hold) {
  EXPECT_EQ(error_of(npy(dictionary("<i4", "(1, 1, 2)"), bytes_of<std::int32_t>({0, 16777217}))),
            "f.npy: frame 0 of 1 has a count at r0c1 beyond 16777216, which cannot be held exactly");
  EXPECT_EQ(error_of(npy(dictionary("<u8", "(1, 2, 1)"), bytes_of<std::uint64_t>({0, ~std::uint64_t{0}}))),
            "f.npy: frame 0 of 1 has a count at r1c0 beyond 16777216, which cannot be held exactly");
}

TEST(Npy, gives_a_value_or_a_one_line_error_for_mutations) {
  const std::string text = npy(dictionary("<u2", "(2, 2, 3)"), std::string(24, 'x'));
  support::expect_value_or_one_line_error(text, 20000, [](const std::string& t) { return parse(t, {}, "mutated"); });
}

void expect_round_trip(FrameShape shape, const std::vector<RawFrame>& frames, const std::string& type) {
  const support::TemporaryFolder folder;
  const auto writer = NpyWriter::create(folder.file("f.npy"), shape);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(support::write_all(**writer, frames));
  const auto reader = NpyReader::open(folder.file("f.npy"), {1000.0, shape});
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<RawFrame> expected;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    expected.emplace_back();
    expected.back().time = std::chrono::milliseconds(i);
    expected.back().counts = frames[i].counts;
  }
  support::expect_same_frames(**reader, expected);
  EXPECT_NE(support::read_bytes(folder.file("f.npy")).find("'descr': '" + type + "'"), std::string::npos);
}

TEST(Npy, gives_back_every_count) {
  expect_round_trip({1, 1}, {}, "<u2");
  expect_round_trip({3, 4}, support::random_frames(1, 500, 12), "<u2");
  expect_round_trip({3, 4}, support::random_frames(2, 500, 12, support::RandomCounts::any_bits), "<f4");
}

TEST(Npy, rewrites_whole_counts_where_a_later_frame_has_others) {
  std::vector<RawFrame> frames = support::random_frames(3, 300, 4096);  // more than two buffers
  frames[299].counts[7] = 0.5F;
  expect_round_trip({64, 64}, frames, "<f4");
}

TEST(Npy, leaves_nothing_behind_where_the_disk_is_full) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.npy");
  std::vector<RawFrame> frames = support::random_frames(4, 300, 4096);
  frames[290].counts[7] = 0.5F;
  for (const rlim_t size : {0U, 100U, 1'000'000U, 2'300'000U, 3'000'000U}) {
    EXPECT_EQ(support::write_within(size, path,
                                    [&]() -> Status {
                                      const auto writer = NpyWriter::create(path, {64, 64});
                                      if (!writer) return writer.error();
                                      return support::write_all(**writer, frames);
                                    }),
              1);
    EXPECT_EQ(folder.file_count(), 0U);
  }
}

TEST(Npy, needs_a_regular_file) {
  const auto writer = NpyWriter::create("/dev/full", {1, 2});
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().message, "cannot write '/dev/full': this format needs a regular file");
}

Result<NpyTable> table_of(const std::string& bytes) {
  return read_npy_table(std::make_unique<std::istringstream>(bytes), "f.npy");
}

TEST(NpyTable, has_the_columns_of_the_file) {
  const std::string data = bytes_of<float>({1, 2, 3, 4, 5, 6});
  const Result<NpyTable> flat = table_of(npy(dictionary("<f4", "(2, 3)"), data));
  ASSERT_TRUE(flat) << flat.error().message;
  EXPECT_EQ(flat->rows, 2U);
  EXPECT_EQ(flat->cols, 3U);
  EXPECT_EQ(flat->values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  const Result<NpyTable> deep = table_of(npy(dictionary("<f4", "(1, 2, 3)"), data));
  ASSERT_TRUE(deep) << deep.error().message;
  EXPECT_EQ(deep->rows, 1U);
  EXPECT_EQ(deep->cols, 6U);
}

TEST(NpyTable, refuses_columns_without_end) {
  EXPECT_EQ(table_of(npy(dictionary("<f4", "(2, 0)"), "")).error().message,
            "f.npy: has 0 columns; 1 to 1048576 can be read");
  EXPECT_EQ(table_of(npy(dictionary("<f4", "(2, 1048577)"), "")).error().message,
            "f.npy: has 1048577 columns; 1 to 1048576 can be read");
  EXPECT_NE(table_of(npy(dictionary("<f4", "(2, 3)"), "")).error().message.find("cut short"), std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::files
