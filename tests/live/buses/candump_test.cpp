// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/candump.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "support/random_frames.hpp"

namespace dermis::live::buses {
namespace {

const CanArray kArray{.name = "a", .shape = {2, 2}, .id = 5, .row = {CanPlace::Kind::byte, 0}, .first = 1};

Result<std::vector<RawFrame>> parse(const std::string& log, const CandumpOptions& options = {}) {
  const auto source = open_candump(std::make_unique<std::istringstream>(log), "hand.log", kArray, options);
  if (!source) return source.error();
  return support::read_all(**source);
}

std::string error_of(const std::string& log, const CandumpOptions& options = {}) {
  const auto frames = parse(log, options);
  return frames ? "no error" : frames.error().message;
}

TEST(Candump, lines_of_every_style_are_read) {
  for (const std::string line :
       {"(1436509052.249713) vcan0 044#2A366C2BBA", "(1436509052.249713) vcan0 044#2a366c2bba R",
        " (1436509052.249713)  vcan0  044   [5]  2A 36 6C 2B BA", "(1436509052.249713) vcan0 044##12A366C2BBA",
        " (1436509052.249713)  vcan0  RX - -  044   [5]  2A 36 6C 2B BA",
        " (1436509052.249713)  vcan0       044  [05]  2A 36 6C 2B BA   '*6l+.'"}) {
    const auto read = parse_candump_line(line);
    ASSERT_TRUE(read) << line;
    EXPECT_EQ(read->time, Nanos(1'436'509'052'249'713'000));
    EXPECT_EQ(read->interface, "vcan0");
    EXPECT_EQ(read->frame.id, 0x44U);
    EXPECT_EQ(read->frame.data, (std::vector<std::uint8_t>{0x2A, 0x36, 0x6C, 0x2B, 0xBA})) << line;
  }
  EXPECT_EQ(parse_candump_line(" (2015-07-10 05:44:12.249713)  vcan0  044   [0] ")->time,
            Nanos(1'436'507'052'249'713'000));
  EXPECT_EQ(parse_candump_line("can0  1234ABCD   [0] ")->frame.id, 0x1234ABCDU);
  EXPECT_FALSE(parse_candump_line("can0  044   [0] ")->time);
  EXPECT_FALSE(parse_candump_line("(1.0) can0 044#R4")->has_data);
  EXPECT_FALSE(parse_candump_line("can0  044   [2]  remote request")->has_data);
  EXPECT_FALSE(parse_candump_line("(1.0) can0 20000004#0000000000000000")->has_data);
}

TEST(Candump, what_is_no_line_is_none) {
  for (const std::string line :
       {"", "can0", "time_s,r0c0", "(1.0) can0 044#2", "(1.0) can0 0G4#22", "(x) can0 044#22", "(1.0 can0 044#22",
        "(2015-07-10 25:44:12.2) can0 044#22", "(2015-13-10 05:44:12.2) can0 044#22", "(2015 05) can0 044#22",
        "(- :) can0 044#22", "can0 044 [2] 2A", "can0 044 [99] 2A", "can0 044 [2] 2A GG", "(1.0) can0 123456789#22",
        "(1.1234567890) can0 044#22", "(1.0) can0 044##"}) {
    EXPECT_FALSE(parse_candump_line(line)) << line;
  }
}

TEST(Candump, frames_have_the_time_of_their_last_part) {
  const auto frames = parse(
      "(10.0) can0 005#000102\n(10.5) can0 123#FF\n(10.25) can0 005#010304\n\n(11.0) can0 005#000506\r\n"
      "(11.5) can0 005#010708\n");
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_EQ(frames->at(0).time, Nanos(10'250'000'000));
  EXPECT_EQ(frames->at(0).counts, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(frames->at(1).time, Nanos(11'500'000'000));
}

TEST(Candump, without_times_a_rate_gives_them) {
  const std::string log =
      "can0 005 [3] 00 01 02\ncan0 005 [3] 01 03 04\ncan0 005 [3] 00 01 02\ncan0 005 [3] 01 03 04\n";
  EXPECT_EQ(error_of(log), "hand.log:2: has no time: log with candump -l or -t a, or give a rate, as rate=HZ");
  const auto frames = parse(log, {.rate_hz = 50.0});
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->at(1).time, Nanos(20'000'000));
}

TEST(Candump, names_what_is_wrong_with_its_line) {
  EXPECT_EQ(error_of("hello\n"), "hand.log:1: is no line of candump, such as (1436509052.249713) can0 044#2A366C2BBA");
  EXPECT_EQ(error_of("(1.0) can0 005#000102\n(1.0) can1 005#010304\n"),
            "hand.log:2: the array comes from can0 and from can1; choose, as interface=can0");
  EXPECT_EQ(
      parse("(1.0) can0 005#000102\n(1.0) can1 005#010304\n(1.0) can0 005#010304\n", {.interface = "can0"})->size(),
      1U);
  EXPECT_EQ(error_of("(1.0) can0 006#00\n"), "hand.log: has no frame of the array 'a'; is this its map?");
  EXPECT_EQ(error_of("(5.0) can0 005#000102\n(5.0) can0 005#010304\n(0.1) can0 005#000102\n(0.1) can0 005#010304\n"),
            "hand.log:3: the times go back; log with candump -l or -t a, not with differences");
  EXPECT_EQ(error_of(std::string(5000, ' ') + "\n"), "hand.log:0: is longer than a line of candump");
}

TEST(Candump, differences_of_times_are_refused_where_whole_frames_are_as_long) {
  std::string log = "(0.000) can0 005#000102\n";
  for (int k = 0; k < 3; ++k) log += "(0.001) can0 005#010304\n(0.049) can0 005#000102\n";
  EXPECT_EQ(error_of(log), "hand.log:4: the times go back; log with candump -l or -t a, not with differences");
}

TEST(Candump, a_last_line_that_is_cut_is_left_out) {
  EXPECT_EQ(parse("(1.0) can0 005#000102\n(1.0) can0 005#010304\n(2.0) can0 005#0")->size(), 1U);
}

}  // namespace
}  // namespace dermis::live::buses
