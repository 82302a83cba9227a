// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/proposals/look.hpp"

#include <gtest/gtest.h>

#include <string>

#include "streams.hpp"

namespace dermis::bytes::proposals {
namespace {

using test::Bytes;
using test::joined;

constexpr FrameShape kShape{8, 6};

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string lines_of_frames() {
  std::string text;
  std::size_t k = 0;
  for (const test::Frame& frame : test::pressed_frames(kShape))
    text += (k++ % 4 == 3 ? "DEBUG ok\n" : "") + joined(frame, ",") + "\n";
  return text;
}

TEST(Look, is_that_of_the_first_proposal) {
  EXPECT_EQ(look_of(bytes_of(lines_of_frames()), {}),
            "The bytes look like 30 lines of 48 numbers: rows=8, cols=6?; every fifth line begins with 'DEBUG'");
}

TEST(Look, is_that_of_a_person_where_there_is_no_proposal) {
  EXPECT_EQ(look_of({}, {}), "There is not a single byte");
  EXPECT_EQ(look_of(Bytes(40, 0), {}), "Each of them is 0x00");
  EXPECT_EQ(look_of(bytes_of("cut\r\ntemp=21.5 C\r\ntemp=21.6 C\r\n"), {}),
            "They are text whose lines are not numbers alone, such as 'temp=21.5 C'");
  EXPECT_EQ(look_of(bytes_of("7\n1,2,3\n1,2\n1 2 3 4\n"), {}),
            "Their lines have 2 to 4 numbers: print as many in each");
  EXPECT_EQ(look_of(bytes_of("7\n512\n513\n511\n"), {}), "Each line has one number: print a row or a frame in a line");
}

TEST(Look, tells_frames_of_another_size) {
  const Bytes bytes = bytes_of(lines_of_frames());
  EXPECT_FALSE(tell_otherwise(bytes, kShape, {}));
  EXPECT_FALSE(tell_otherwise(bytes, {1, 48}, {}));
  EXPECT_TRUE(tell_otherwise(bytes, {4, 48}, {}));
  EXPECT_FALSE(tell_otherwise(bytes_of("nothing that anybody could read\n"), kShape, {}));
}

}  // namespace
}  // namespace dermis::bytes::proposals
