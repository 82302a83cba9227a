// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

const std::string kHeader =
    "novel emed-x                          Page   1\r\nFile name: step.pli\r\nSensor size:  0.50 x 0.50 [cm]\r\n"
    "Time per picture:  20.00 [ms]\r\n\r\n";

std::string page(const std::string& picture, const std::string& table) {
  return "Page\r\nPict-No.: " + picture + "    Time: 0.000 s\r\n\r\n" + table + "\r\n\x0C\r\n";
}

std::string with_tabs() {
  return kHeader + page("1", "\t11\t12\tForce\r\n7\t10.0\t\t5.0\r\n8\t12.5\t3.0\t7.0\r\nForce\t1\t2\t3\r\n") +
         page("3", "\t12\t13\tForce\r\n7\t1.0\t2.0\t1.5\r\nForce\t1\t2\t3\r\n") +
         page("MPP", "\t11\t12\tForce\r\n7\t99.0\t99.0\t99\r\n");
}

std::string in_columns() {
  return kHeader +
         page("1",
              "              11      12   Force\r\n       7    10.0             5.0\r\n       8    12.5     3.0     "
              "7.0\r\n   Force     1.0     2.0     3.0\r\n") +
         page("3", "              12\r\n       7     1.0\r\n") + page("3", "              13\r\n       7     2.0\r\n") +
         page("MVP", "              11\r\n       7    99.0\r\n");
}

const Frames kPressed = {{10, 0, 0, 12.5F, 3, 0}, {0, 1, 2, 0, 0, 0}};

TEST(NovelLst, reads_the_smallest_rectangle_that_holds_all_tables) {
  Importer importer(open_novel_lst);
  for (const std::string& text : {with_tabs(), in_columns()}) {
    EXPECT_EQ(importer.counts(text), kPressed);
    EXPECT_EQ(importer.shape(), (FrameShape{2, 3}));
    EXPECT_EQ(importer.seconds(text), (std::vector<double>{0.02, 0.06}));
  }
}

TEST(NovelLst, lies_at_its_place_on_a_platform_that_is_given) {
  const Frames frames = Importer(open_novel_lst, {.shape = FrameShape{8, 16}}).counts(with_tabs());
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(frames[0].size(), 128U);
  EXPECT_EQ(frames[0][6 * 16 + 10], 10.0F);
  EXPECT_EQ(frames[0][7 * 16 + 11], 3.0F);
  EXPECT_EQ(frames[1][6 * 16 + 12], 2.0F);
  EXPECT_EQ(Importer(open_novel_lst, {.shape = FrameShape{8, 12}}).error(with_tabs()),
            "f: has 8x13 taxels, the array is 8x12");
}

TEST(NovelLst, loses_only_the_frame_that_is_cut) {
  Importer importer(open_novel_lst, {.shape = FrameShape{8, 16}});
  const std::string whole = with_tabs();
  const std::size_t end = whole.find("\t1.0\t2.0") + 6;
  EXPECT_EQ(importer.counts(whole.substr(0, end)).size(), 1U);
  EXPECT_EQ(importer.losses(), std::vector<std::string>{"f:19: is cut off; the 1 frame before is read"});
}

TEST(NovelLst, keeps_the_picture_before_a_page_that_is_cut_above_its_values) {
  Importer importer(open_novel_lst);
  const std::string next = "Page\r\nPict-No.: 4    Time: 0.000 s\r\n\r\n\t12\t13\tForce";
  const std::string whole = with_tabs().substr(0, with_tabs().find("Page\r\nPict-No.: MPP"));
  for (std::size_t size = 0; size <= next.size(); ++size) {
    EXPECT_EQ(importer.counts(whole + next.substr(0, size)), kPressed) << size;
  }
  EXPECT_EQ(importer.losses(), std::vector<std::string>{"f:26: is cut off; the 2 frames before are read"});
}

TEST(NovelLst, names_what_is_wrong) {
  Importer importer(open_novel_lst);
  EXPECT_EQ(importer.error(kHeader), "f:5: the file ends before its first table of pressures");
  EXPECT_EQ(importer.error(kHeader + page("1", "\t11\r\n7\tmuch\r\n")), "f:10: 'much' is not a number");
  const std::string table = "\t11\r\n7\t1\r\n";
  EXPECT_EQ(importer.error(kHeader + page("3", table) + page("2", table)), "f:17: picture 2 follows picture 3");
  EXPECT_EQ(importer.error(kHeader + page("900000000000", table)),
            "f:10: picture 900000000000 would be later than 9e9 seconds, by the time per picture");
  EXPECT_EQ(importer.error(page("1", "\t11\r\n7\t1\r\n")), "f:7: the file does not tell the time per picture");
}

TEST(NovelLst, tells_a_file_that_cannot_be_read_or_is_a_pipe) {
  Importer importer(open_novel_lst);
  EXPECT_EQ(importer.fault(with_tabs(), BadFile::Fault::read).message, "cannot read 'f': Input/output error");
  EXPECT_EQ(importer.fault(with_tabs(), BadFile::Fault::seek).message,
            "f: cannot be read from a pipe; save it as a file");
}

TEST(NovelLst, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer importer(open_novel_lst);
  importer.expect_value_or_one_line_error(with_tabs(), 10000);
  importer.expect_value_or_one_line_error(in_columns(), 10000);
}

}  // namespace
}  // namespace dermis::bytes::formats
