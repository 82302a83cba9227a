// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <cmath>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

const Frames kTwo = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12.5F}};

TEST(TextMatrix, reads_blocks_with_any_separators) {
  Importer importer(open_text_matrix, {.rate_hz = 100.0});
  for (const std::string text :
       {"1,2,3\n4,5,6\n\n7,8,9\n10,11,12.5\n", "1 2 3\n4 5 6\n\n7 8 9\n10 11 12.5",
        "1\t2\t3\r\n4\t5\t6\r\n\r\n7\t8\t9\r\n10\t11\t12.5\r\n", "1; 2; 3\n4; 5; 6\n\n\n7; 8; 9\n10; 11; 12.5\n\n",
        "  1  2 , 3\n 4  5,6,\n\n7 8 9\n10 11 12.5",
        "\xEF\xBB\xBF# made by hand\n1,2,3\n4,5,6\n# frame 2\n7,8,9\n10,11,12.5\n",
        "left,middle,right\n\"1\",\"2\",\"3\"\n4,5,6\nFrame 2:\n7,8,9\n10,11,12.5\n"}) {
    EXPECT_EQ(importer.counts(text), kTwo) << text;
    EXPECT_EQ(importer.shape(), (FrameShape{2, 3}));
    EXPECT_TRUE(importer.losses().empty());
  }
  EXPECT_EQ(importer.seconds("1\n\n2\n\n3\n"), (std::vector<double>{0.0, 0.01, 0.02}));
}

TEST(TextMatrix, takes_decimal_commas_between_semicolons_and_tabs) {
  Importer importer(open_text_matrix, {.rate_hz = 100.0});
  const Frames expected = {{1.5F, 2, 0.25F}};
  EXPECT_EQ(importer.counts("1,5;2;0,25\n"), expected);
  EXPECT_EQ(importer.counts("1,5\t2\t0,25\n"), expected);
  EXPECT_EQ(importer.counts("1.5,\t2,\t0.25\n"), expected);
  EXPECT_EQ(importer.counts("1.5, 2, 0.25\n"), expected);
}

TEST(TextMatrix, with_a_shape_needs_no_lines_between) {
  Importer importer(open_text_matrix, {.shape = FrameShape{2, 3}, .rate_hz = 1.0});
  EXPECT_EQ(importer.counts("1,2,3\n4,5,6\n7,8,9\n10,11,12.5\n"), kTwo);
  Importer strip(open_text_matrix, {.shape = FrameShape{1, 2}, .rate_hz = 1.0});
  EXPECT_EQ(strip.counts("1,2\n3,4\n5,6\n"), (Frames{{1, 2}, {3, 4}, {5, 6}}));
}

TEST(TextMatrix, with_a_shape_a_line_of_all_its_values_is_a_frame) {
  Importer importer(open_text_matrix, {.shape = FrameShape{2, 3}, .rate_hz = 1.0});
  EXPECT_EQ(importer.counts("1,2,3,4,5,6\n7,8,9,10,11,12.5\n"), kTwo);
}

TEST(TextMatrix, asks_whether_lines_are_frames_where_nothing_tells) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  EXPECT_EQ(importer.counts("1 2 3 4\n5 6 7 8\n").size(), 1U);
  EXPECT_EQ(importer.notices(), std::vector<std::string>{
                                    "f: 2 lines of 4 numbers are read as one frame; if each line is a frame, give rows "
                                    "and cols, as rows=2 and cols=2"});
  EXPECT_EQ(importer.counts("1 2\n3 4\n\n5 6\n7 8\n").size(), 2U);
  EXPECT_TRUE(importer.notices().empty());
  EXPECT_EQ(importer.counts("1 2\n3 4\n").size(), 1U);
  EXPECT_TRUE(importer.notices().empty());
}

TEST(TextMatrix, takes_what_is_empty_for_a_missing_reading) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  const Frames frames = importer.counts(",2,3\n4,nan,\n");
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].size(), 6U);
  EXPECT_TRUE(std::isnan(frames[0][0]) && std::isnan(frames[0][4]) && std::isnan(frames[0][5]));
  EXPECT_EQ(frames[0][1], 2.0F);
}

TEST(TextMatrix, takes_separators_with_nothing_between_for_missing_readings) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  for (const std::string text :
       {"1,2,3\n,,\n4,,6\n", "1\t2\t3\n;;\n4\t\t6\n", "1;2;3\n ; ; \n4;;6\n", "1\t2\t3\n,,\r\n4 \t \t 6\r\n"}) {
    const Frames frames = importer.counts(text);
    ASSERT_EQ(frames.size(), 1U) << text;
    ASSERT_EQ(frames[0].size(), 9U) << text;
    for (const std::size_t i : {3U, 4U, 5U, 7U}) EXPECT_TRUE(std::isnan(frames[0][i])) << text << i;
    EXPECT_EQ(frames[0][8], 6.0F) << text;
  }
  EXPECT_EQ(importer.counts("1\t2\n \t \n3\t4\n"), (Frames{{1, 2}, {3, 4}})) << "a line of blanks is none";
}

TEST(TextMatrix, reads_lines_of_any_length) {
  for (const std::size_t length : {65534U, 65535U, 65536U, 65537U, 200'000U}) {
    const std::string blanks(length - 2, ' ');
    std::string text = "1";
    text.append(blanks).append("2\r\n1").append(blanks).append("2\n3 4");
    EXPECT_EQ(Importer(open_text_matrix, {.rate_hz = 1.0}).counts(text), (Frames{{1, 2, 1, 2, 3, 4}}));
  }
}

TEST(TextMatrix, tells_a_file_that_cannot_be_read) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  for (const std::string text : {"", "1,2", "1,2\n3,4\n\n"}) {
    const Error error = importer.fault(text, BadFile::Fault::read);
    EXPECT_EQ(error.kind, ErrorKind::failed);
    EXPECT_EQ(error.message, "cannot read 'f': Input/output error");
  }
}

TEST(TextMatrix, loses_only_the_block_that_is_cut) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  const Frames first = {kTwo[0]};
  for (const std::string rest : {"7,8", "7,8,9", "7,8,9\n", "7,8,9\n10,1", "7,8,9\n10,11,", "7,8,9\n10,11,1x"}) {
    EXPECT_EQ(importer.counts("1,2,3\n4,5,6\n\n" + rest), first) << rest;
    ASSERT_EQ(importer.losses().size(), 1U) << rest;
    EXPECT_TRUE(importer.losses()[0].ends_with(": is cut off; the 1 frame before is read"));
  }
  Importer strip(open_text_matrix, {.shape = FrameShape{1, 3}, .rate_hz = 1.0});
  for (const std::string rest : {"4", "4,", "4,5,", "4,,"}) {
    EXPECT_EQ(strip.counts("1,2,3\n" + rest), (Frames{{1, 2, 3}})) << rest;
  }
  EXPECT_EQ(strip.counts("1,2,3,\n4,5,6,"), (Frames{{1, 2, 3}, {4, 5, 6}})) << "a separator at the end of each row";
}

TEST(TextMatrix, names_the_line_that_is_wrong) {
  Importer importer(open_text_matrix, {.rate_hz = 1.0});
  EXPECT_EQ(importer.error("1,2\n3,x\n"), "f:2: 'x' is not a number");
  EXPECT_EQ(importer.error("1,2\n3,4,5\n"), "f:2: has 3 values instead of 2");
  EXPECT_EQ(importer.error("1,2\n3\n5,6\n"), "f:2: has 1 value instead of 2");
  EXPECT_EQ(importer.error("1,2\n3,4\n\n5,6\n\n7,8\n9,10\n"),
            "f:5: a block of 1x2 numbers ends here, the first has 2x2");
  EXPECT_EQ(importer.error(""), "f:1: there is no line of numbers");
  EXPECT_EQ(importer.error("a,b\n\n"), "f:2: there is no line of numbers");
  EXPECT_EQ(importer.error("\xFF\xFEx"), "f:1: is UTF-16 text; save it as UTF-8");
  std::string rows;
  for (int row = 0; row < 1025; ++row) rows += "1,2\n";
  EXPECT_EQ(importer.error(rows),
            "f:1025: more than 1024 rows without a blank line between: say how many rows and cols a frame has");
  Importer larger(open_text_matrix, {.shape = FrameShape{2, 2}, .rate_hz = 1.0});
  EXPECT_EQ(larger.error("1,2,3\n4,5,6\n"), "f: has 2x3 taxels, the array is 2x2");
}

TEST(TextMatrix, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer(open_text_matrix, {.rate_hz = 1.0})
      .expect_value_or_one_line_error("1,2,3\n4,5,6\n\n7;8;9\n10 11 12\n", 20000);
}

}  // namespace
}  // namespace dermis::bytes::formats
