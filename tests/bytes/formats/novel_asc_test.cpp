// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

const std::string kHead = "file name:\tstep.sol\tdate/time\t01.01.20 10.00\r\nsensor type:\tpedar\r\n\r\n";
const std::string kNumbers = "time[secs]\t 1\t 2\t 3\t 4\r\n";
const std::string kLines = " 3600.01\t 1.0\t 2.5\t 0.0\t 4.0\r\n 3600.02\t 1.5\t 2.5\t 0.5\t 4.5\r\n";

TEST(NovelAsc, reads_a_frame_a_line) {
  Importer importer(open_novel_asc);
  EXPECT_EQ(importer.counts(kHead + kNumbers + kLines), (Frames{{1.0F, 2.5F, 0.0F, 4.0F}, {1.5F, 2.5F, 0.5F, 4.5F}}));
  EXPECT_EQ(importer.shape(), (FrameShape{1, 4}));
  EXPECT_EQ(importer.seconds(kHead + kNumbers + kLines), (std::vector<double>{3600.01, 3600.02}));
}

TEST(NovelAsc, takes_the_shape_that_is_given) {
  Importer importer(open_novel_asc, {.shape = FrameShape{2, 2}});
  EXPECT_EQ(importer.counts(kNumbers + kLines).size(), 2U);
  EXPECT_EQ(importer.shape(), (FrameShape{2, 2}));
  EXPECT_EQ(Importer(open_novel_asc, {.shape = FrameShape{2, 3}}).error(kNumbers + kLines),
            "f: has 1x4 taxels, the array is 2x3");
}

TEST(NovelAsc, reads_milliseconds_and_decimal_commas) {
  const std::string text = "time[ms]\t1\t2\n10\t1,5\t2\n20\t2,5\t3\n";
  Importer importer(open_novel_asc);
  EXPECT_EQ(importer.counts(text), (Frames{{1.5F, 2.0F}, {2.5F, 3.0F}}));
  EXPECT_EQ(importer.seconds(text), (std::vector<double>{0.01, 0.02}));
}

TEST(NovelAsc, leaves_out_a_last_frame_that_is_cut) {
  Importer importer(open_novel_asc);
  EXPECT_EQ(importer.counts(kNumbers + kLines + " 3600.03\t 1.5\t 2").size(), 2U);
  ASSERT_EQ(importer.losses().size(), 1U);
  EXPECT_EQ(importer.losses().front(), "f:4: is cut off; the 2 frames before are read");
}

TEST(NovelAsc, names_what_is_wrong) {
  Importer importer(open_novel_asc);
  EXPECT_EQ(importer.error(kHead), "f:3: the file ends before a line 'time[secs]' with the numbers of the sensors");
  EXPECT_EQ(importer.error(kNumbers + "0.01\t1\t2\t3\n"), "f:2: has 3 values instead of 4");
  EXPECT_EQ(importer.error(kNumbers + "MPP\t1\t2\t3\t4\n"), "f:2: begins with no time");
  EXPECT_EQ(importer.error(kNumbers + "0.01\t1\tx\t3\t4\n"), "f:2: 'x' is not a number");
  EXPECT_EQ(importer.error("time[secs]\n0.01\n"), "f: has frames of 1x0 taxels; 1x1 to 1024x1024 can be read");
}

TEST(NovelAsc, survives_damage) {
  Importer importer(open_novel_asc);
  importer.expect_value_or_one_line_error(kHead + kNumbers + kLines, 2000);
}

}  // namespace
}  // namespace dermis::bytes::formats
