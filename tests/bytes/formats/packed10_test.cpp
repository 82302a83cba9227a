// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

TEST(Packed10, reads_ten_bits_a_reading_the_highest_first) {
  Importer importer(open_packed10, {.shape = FrameShape{1, 4}, .rate_hz = 50.0});
  // 1023, 0, 1, 512
  const std::string frame = std::string("\xFF\xC0\x00\x06\x00", 5);
  EXPECT_EQ(importer.counts(frame + frame), (Frames{{1023, 0, 1, 512}, {1023, 0, 1, 512}}));
  EXPECT_EQ(importer.seconds(frame + frame), (std::vector<double>{0.0, 0.02}));
}

TEST(Packed10, begins_each_frame_with_a_byte) {
  Importer importer(open_packed10, {.shape = FrameShape{1, 3}, .rate_hz = 50.0});
  // 1, 2, 3 and two bits that are not used
  const std::string frame = std::string("\x00\x40\x20\x0C", 4);
  EXPECT_EQ(importer.counts(frame + frame), (Frames{{1, 2, 3}, {1, 2, 3}}));
}

TEST(Packed10, loses_only_the_frame_that_is_cut) {
  Importer importer(open_packed10, {.shape = FrameShape{1, 4}, .rate_hz = 50.0});
  EXPECT_EQ(importer.counts(std::string(9, '\0')).size(), 1U);
  EXPECT_EQ(importer.losses(), std::vector<std::string>{"f: is cut off; the 1 frame before is read"});
}

TEST(Packed10, tells_a_file_that_cannot_be_read) {
  Importer importer(open_packed10, {.shape = FrameShape{1, 4}, .rate_hz = 50.0});
  EXPECT_EQ(importer.fault(std::string(9, '\0'), BadFile::Fault::read).message, "cannot read 'f': Input/output error");
}

TEST(Packed10, needs_a_shape) {
  EXPECT_EQ(Importer(open_packed10, {.rate_hz = 50.0}).error("abcde"),
            "f: packed readings do not tell their shape: say how many rows and cols");
}

}  // namespace
}  // namespace dermis::bytes::formats
