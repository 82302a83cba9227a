// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <bzlib.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdio>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

std::string code(const std::vector<float>& numbers) {
  std::string text;
  for (const float number : numbers) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08X", std::bit_cast<std::uint32_t>(number));
    text += std::string("\r\n        ") + digits.data();
  }
  return text;
}

std::string frame(int index, int milliseconds, const std::vector<float>& numbers) {
  return "<frame index=\"" + std::to_string(index) + "\">\r\n<time_stamp>" + std::to_string(milliseconds) +
         "</time_stamp><frame_data>" + code(numbers) + "\r\n      </frame_data></frame>\r\n";
}

/// A hand with two matrices, 2x3 and 1x2.
std::string recording(const std::string& frames) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<root>\r\n<sensor name=\"\"><num_matrices>2</num_matrices>\r\n"
         "<matrix index=\"0\"><cells_x>3</cells_x><cells_y>2</cells_y><static_mask>\r\n "
         "111\r\n</static_mask></matrix>\r\n"
         "<matrix index=\"1\"><cells_x>2</cells_x><cells_y>1</cells_y></matrix>\r\n</sensor>\r\n<data>"
         "<frame_count>2</frame_count>\r\n" +
         frames +
         "</data>\r\n<temperatures><temp_count>2</temp_count>\r\n"
         "<temp index=\"0\"><time_stamp>1000</time_stamp><temp_data>20.00, 21.50, 22.00</temp_data></temp>\r\n"
         "<temp index=\"1\"><time_stamp>1020</time_stamp><temp_data>20.00, 23.50, 24.00</temp_data></temp>\r\n"
         "</temperatures>\r\n<joint_angles><angle_count>1</angle_count><angle index=\"0\"><time_stamp>5</time_stamp>"
         "<angle_data>1.0, 2.0</angle_data></angle></joint_angles>\r\n</root>\r\n";
}

const std::vector<float> kFirst = {7, -2, 300.5F, -3, 9};  // 7 0 0 300.5 0 0 | 0 9
const std::vector<float> kSecond = {-8};

std::string two_frames() {
  return recording(frame(0, 990, kFirst) + frame(1, 1030, kSecond));
}

std::string compressed(std::string text) {
  std::string packed(text.size() + text.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), static_cast<unsigned>(text.size()), 1, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}

TEST(Dsa, reads_one_of_the_matrices_with_the_temperature_of_its_axis) {
  Importer proximal(open_dsa, {.array = "0"});
  Importer distal(open_dsa, {.array = "1"});
  for (const std::string& bytes : {compressed(two_frames()), two_frames()}) {
    EXPECT_EQ(proximal.counts(bytes), (Frames{{7, 0, 0, 300.5F, 0, 0}, {0, 0, 0, 0, 0, 0}}));
    EXPECT_EQ(proximal.shape(), (FrameShape{2, 3}));
    EXPECT_EQ(proximal.seconds(bytes), (std::vector<double>{0.99, 1.03}));
    const auto frames = distal.read(bytes);
    ASSERT_TRUE(frames);
    EXPECT_EQ((*frames)[0].counts, (std::vector<float>{0, 9}));
    EXPECT_EQ((*frames)[0].temperature_celsius, 22.0) << "there is no earlier one";
    EXPECT_EQ((*frames)[1].temperature_celsius, 24.0);
  }
}

TEST(Dsa, asks_which_matrix_where_there_are_several) {
  EXPECT_EQ(Importer(open_dsa).error(two_frames()), "f: has 2 matrices; name one by its number, as 'f#0'");
  EXPECT_EQ(Importer(open_dsa, {.array = "2"}).error(two_frames()),
            "f: has 2 matrices; name one by its number, as 'f#0'");
}

TEST(Dsa, loses_only_the_frame_that_is_cut) {
  Importer importer(open_dsa, {.array = "1"});
  const std::string whole = two_frames();
  const std::size_t begin = whole.find("<frame index=\"1\"");
  const std::size_t end = whole.find("</frame>", begin);
  for (std::size_t size = begin; size < end + 8; ++size) {
    EXPECT_EQ(importer.counts(whole.substr(0, size)), (Frames{{0, 9}})) << size;
    EXPECT_EQ(importer.losses().size(), 1U) << size;
  }
}

TEST(Dsa, tells_once_that_times_run_backwards) {
  Importer importer(open_dsa, {.array = "1"});
  const std::string text =
      recording(frame(0, 20, kFirst) + frame(1, 10, kSecond) + frame(2, 30, kSecond) + frame(3, 5, kSecond));
  EXPECT_EQ(importer.seconds(text), (std::vector<double>{0.02, 0.01, 0.03, 0.005}));
  ASSERT_EQ(importer.notices().size(), 1U);
  EXPECT_TRUE(importer.notices()[0].ends_with(": the time_stamp of the frame is before that of the last one"));
}

TEST(Dsa, reads_what_is_whole_of_a_compressed_file_that_is_cut) {
  std::string frames;
  for (int i = 0; i < 30000; ++i) frames += frame(i, i, {static_cast<float>(i % 997), -7});
  const std::string whole = compressed(recording(frames));
  Importer importer(open_dsa, {.array = "0"});
  const Frames counts = importer.counts(whole.substr(0, whole.size() / 2));
  EXPECT_GT(counts.size(), 1000U);
  EXPECT_LT(counts.size(), 30000U);
  EXPECT_EQ(importer.losses().size(), 1U);
  EXPECT_EQ(importer.counts(whole).size(), 30000U);
}

TEST(Dsa, names_what_is_wrong) {
  Importer importer(open_dsa, {.array = "0"});
  const std::string message = ": the code of the frame is wrong, or has not the cells of the matrices";
  for (const std::vector<float>& numbers : {std::vector<float>{-7}, std::vector<float>{-9}, std::vector<float>{}}) {
    EXPECT_TRUE(importer.error(recording(frame(0, 1, numbers))).ends_with(message));
  }
  EXPECT_TRUE(importer.error("<root><sensor></sensor><data></root>").starts_with("f:1: is no XML: "));
  EXPECT_EQ(importer.error("<!DOCTYPE root [<!ENTITY a \"b\">]><root/>"),
            "f:1: has a document type, which no DSA recording has");
  EXPECT_EQ(importer.error(recording("")), "f:17: there is no frame");
  EXPECT_EQ(Importer(open_dsa, {.shape = FrameShape{3, 2}, .array = "0"}).error(two_frames()),
            "f: has 2x3 taxels, the array is 3x2");
}

TEST(Dsa, refuses_what_would_fill_the_memory) {
  Importer importer(open_dsa, {.array = "0"});
  std::string deep;
  std::string names;
  std::string attributes;
  for (int i = 0; i < 100'000; ++i) {
    deep += "<a>";
    names += "<n" + std::to_string(i) + "/>";
    attributes += "<n a" + std::to_string(i) + "=\"\"/>";
  }
  EXPECT_EQ(importer.error(deep), "f:1: has elements more than 32 deep in each other, which no DSA recording has");
  for (const std::string& many : {names, attributes}) {
    EXPECT_EQ(importer.error("<root>" + many), "f:1: has names of elements and attributes of more than 64 KiB");
  }
  std::string comment = "<root><!--";
  comment.resize(20'000'000, 'x');
  EXPECT_EQ(importer.error(comment), "f:1: has a tag or a comment of more than 1 MiB");
}

TEST(Dsa, has_the_temperature_of_its_axis_also_where_temperatures_come_first) {
  std::string text = two_frames();
  const std::size_t begin = text.find("<temperatures>");
  const std::size_t end = text.find("<joint_angles>");
  const std::string temperatures = text.substr(begin, end - begin);
  text.erase(begin, end - begin).insert(text.find("<data>"), temperatures);
  const auto frames = Importer(open_dsa, {.array = "1"}).read(text);
  ASSERT_TRUE(frames);
  EXPECT_EQ((*frames)[1].temperature_celsius, 24.0);
}

TEST(Dsa, tells_a_file_that_cannot_be_read_or_is_a_pipe) {
  Importer importer(open_dsa, {.array = "0"});
  for (const std::string& bytes : {two_frames(), compressed(two_frames())}) {
    const Error unreadable = importer.fault(bytes.substr(0, bytes.size() - 9), BadFile::Fault::read);
    EXPECT_EQ(unreadable.kind, ErrorKind::failed);
    EXPECT_EQ(unreadable.message, "cannot read 'f': Input/output error");
    EXPECT_EQ(importer.fault(bytes, BadFile::Fault::seek).message, "f: cannot be read from a pipe; save it as a file");
  }
}

TEST(Dsa, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer importer(open_dsa, {.array = "0"});
  importer.expect_value_or_one_line_error(two_frames(), 10000);
  importer.expect_value_or_one_line_error(compressed(two_frames()), 10000);
}

}  // namespace
}  // namespace dermis::bytes::formats
