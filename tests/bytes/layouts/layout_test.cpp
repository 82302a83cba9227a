// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/layouts/checksum_of.hpp"

namespace dermis::bytes::layouts {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Readings = std::vector<std::vector<float>>;

constexpr const char* kTwoByTwo = "[layout]\nrows = 2\ncols = 2\n";

Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

std::shared_ptr<const Layout> layout_of(const std::string& toml) {
  Result<Layout> layout = layout_from_toml(toml, "it.toml");
  EXPECT_TRUE(layout) << layout.error().message;
  return std::make_shared<const Layout>(*std::move(layout));
}

std::string error_of(const std::string& toml) {
  const Result<Layout> layout = layout_from_toml(toml, "it.toml");
  return layout ? std::string() : layout.error().message;
}

std::vector<RawFrame> frames_of(Decoder& decoder, const Bytes& bytes, std::size_t piece = 7) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
    while (decoder.next(frame)) frames.push_back(frame);
  }
  decoder.finish();
  while (decoder.next(frame)) frames.push_back(frame);
  return frames;
}

std::vector<RawFrame> frames_of(const std::string& toml, const Bytes& bytes, std::size_t array = 0) {
  return frames_of(*make_decoder(layout_of(toml), array, true), bytes);
}

Readings readings_of(const std::vector<RawFrame>& frames) {
  Readings readings;
  for (const RawFrame& frame : frames) readings.push_back(frame.counts);
  return readings;
}

Readings readings_of(const std::string& keys, std::string_view text) {
  return readings_of(frames_of(kTwoByTwo + keys, bytes_of(text)));
}

Readings readings_of(const std::string& keys, const Bytes& bytes) {
  return readings_of(frames_of(kTwoByTwo + keys, bytes));
}

const Readings kOneToEight = {{1, 2, 3, 4}, {5, 6, 7, 8}};

TEST(TextLayout, a_line_is_a_frame_whatever_separates_its_values) {
  for (const char* line : {"1 2 3 4\n5 6 7 8\n", "1,2,3,4,\r\n5,6,7,8,\r\n", "[[1, 2], [3, 4]]\n[[5, 6], [7, 8]]\n",
                           "1,2;3,4\n5,6;7,8\n", "\t1\t2\t3\t4\n5.0 6e0 +7 8.\n"}) {
    EXPECT_EQ(readings_of("line = \"{values}\"\n", line), kOneToEight) << line;
  }
}

TEST(TextLayout, rows_and_taxels_may_be_counted_from_1_on) {
  EXPECT_EQ(readings_of("line = \"{row-1}: {values}\"\n", "2: 3 4\n1: 1 2\n0: 9 9\n1: 5 6\n2: 7 8\n"), kOneToEight);
  EXPECT_EQ(readings_of("line = \"{first-1} {value}\"\n", "1 1\n2 2\n3 3\n4 4\n1 5\n2 6\n3 7\n4 8\n"), kOneToEight);
}

TEST(PacketLayout, has_at_most_64_arrays) {
  std::string toml = "[layout]\npacket = [\"AA\", \"values u8\"]\n";
  for (int k = 0; k < 65; ++k) toml += "[[layout.array]]\nname = \"a" + std::to_string(k) + "\"\nrows = 1\ncols = 1\n";
  EXPECT_NE(error_of(toml).find("more than 64"), std::string::npos);
}

TEST(TextLayout, a_row_may_follow_the_mark_of_a_frame) {
  const std::string keys = "line = \"{values}\"\nframe_begin = \"\\u001b[H\"\n";
  EXPECT_EQ(readings_of(keys, "3 4\n\x1b[H1 2\n3 4\n\x1b[H5 6\n7 8\n"), kOneToEight);
}

TEST(TextLayout, rows_come_in_any_order_by_their_numbers) {
  EXPECT_EQ(readings_of("line = \"{row},{values}\"\n", "1,3,4\n0,1,2\n1,7,8\n0,5,6\n"), kOneToEight);
}

TEST(TextLayout, lines_may_count_from_one_and_others_are_told) {
  EXPECT_EQ(readings_of("line = \"{row-1},{values}\"\n", "2,3,4\n1,1,2\n1,5,6\n2,7,8\n"), kOneToEight);
  const auto decoder = make_decoder(layout_of(std::string(kTwoByTwo) + "line = \"{row},{values}\"\n"), 0, false);
  EXPECT_TRUE(frames_of(*decoder, bytes_of("1,1,2\n2,3,4\n1,1,2\n2,3,4\n")).empty());
  EXPECT_EQ(decoder->advice(), "row 2 is outside of 2x2: lines count from 0, or from 1 as {row-1}");
  const auto larger =
      make_decoder(layout_of(std::string("[layout]\nrows = 3\ncols = 2\nline = \"{row},{values}\"\n")), 0, false);
  EXPECT_TRUE(frames_of(*larger, bytes_of("0,1,2\n1,3,4\n0,1,2\n1,3,4\n")).empty());
  EXPECT_EQ(larger->advice(), "no frame is complete: at most 4 of 6 readings came");
}

TEST(TextLayout, rows_without_a_number_end_with_a_line_of_their_own) {
  const std::string keys = "line = \"{values}\"\nframe_end = ";
  EXPECT_EQ(readings_of(keys + "\"\"\n", "1 2\n3 4\n\n5 6\n7 8\n\n"), kOneToEight);
  EXPECT_EQ(readings_of(keys + "\"--\"\n", "3 4\n--\n1 2\n3 4\n-- 1\n9 9\n--\n5 6\n7 8\n--\n"), kOneToEight);
}

TEST(TextLayout, taxels_make_a_frame_when_all_have_come) {
  EXPECT_EQ(readings_of("line = \"{row};{col};{value}\"\n", "0;0;1\n0;1;2\n1;1;4\n1;0;3\n0;0;5\n0;1;6\n1;0;7\n1;1;8\n"),
            kOneToEight);
}

TEST(TextLayout, the_last_line_of_a_file_needs_no_end_and_that_of_a_device_does) {
  const auto layout = layout_of(std::string(kTwoByTwo) + "line = \"{values}\"\n");
  const Bytes bytes = bytes_of("1 2 3 4\n5 6 7 8");
  const auto file = make_decoder(layout, 0, true);
  EXPECT_EQ(readings_of(frames_of(*file, bytes)), kOneToEight);
  EXPECT_EQ(file->frame_end(), bytes.size());
  EXPECT_EQ(frames_of(*make_decoder(layout, 0, false), bytes).size(), 1U);
}

TEST(TextLayout, hexadecimal_numbers_may_have_their_prefix) {
  EXPECT_EQ(readings_of("line = \"{values}\"\ndigits = \"hexadecimal\"\n", "0x1,0x2,0x3,0x4\n05 06 7 8\n"),
            kOneToEight);
}

TEST(TextLayout, numbers_may_be_signed_broken_hexadecimal_or_of_one_width) {
  EXPECT_EQ(readings_of("line = \"{values}\"\ndecimal_point = \",\"\n", "1,5 -2 3e1;4\n"),
            (Readings{{1.5, -2, 30, 4}}));
  EXPECT_EQ(readings_of("line = \"{values}\"\ndigits = \"hexadecimal\"\n", "0a FF 10 3\n"),
            (Readings{{10, 255, 16, 3}}));
  EXPECT_EQ(readings_of("line = \"p{values}\"\ndigits = \"hexadecimal\"\nwidth = 3\n", "p00aFFF010003\n"),
            (Readings{{10, 4095, 16, 3}}));
}

TEST(TextLayout, a_byte_order_mark_is_no_part_of_the_first_line) {
  EXPECT_EQ(readings_of("line = \"{values}\"\n",
                        "\xEF\xBB\xBF"
                        "1 2 3 4\n5 6 7 8\n"),
            kOneToEight);
}

TEST(TextLayout, missing_readings_are_not_numbers) {
  const Readings readings =
      readings_of("line = \"{values}\"\nabsent = 0\nscale = -1.0\noffset = 10.0\n", "1,,nan,0\n1,null,None,--\n");
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0][0], 9.0F);
  for (const std::vector<float>& frame : readings) {
    EXPECT_TRUE(std::all_of(frame.begin() + 1, frame.end(), [](float x) { return std::isnan(x); }));
  }
}

TEST(TextLayout, what_surrounds_the_readings_goes_into_the_frame) {
  const auto frames = frames_of(
      std::string(kTwoByTwo) + "line = \"t={time_ms} #{frame} {temperature}C {supply}V: {values} ({skip})\"\n",
      bytes_of("t=1000 #7 21.5C 3.3V: 1 2 3 4 (ok)\nt=1020.5 #10 21.5C 3.3V: 5 6 7 8 ()\n"));
  EXPECT_EQ(readings_of(frames), kOneToEight);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].acquisition.device_time, Nanos(1'020'500'000));
  EXPECT_EQ(frames[1].acquisition.sequence, 10U);
  EXPECT_EQ(frames[1].acquisition.lost_before, 2U);
  EXPECT_EQ(frames[1].temperature_celsius, 21.5);
  EXPECT_EQ(frames[1].supply_v, 3.3);
}

TEST(TextLayout, several_temperatures_are_those_of_sensors) {
  const auto frames =
      frames_of(std::string(kTwoByTwo) + "line = \"{temperature} {temperature} {temperature}: {values}\"\n",
                bytes_of("21.5 22 23: 1 2 3 4\n20 nan 22: 5 6 7 8\n"));
  EXPECT_EQ(readings_of(frames), kOneToEight);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].sensor_celsius, (std::vector<float>{21.5F, 22.0F, 23.0F}));
  EXPECT_NEAR(*frames[0].temperature_celsius, 66.5 / 3.0, 1e-6);
  ASSERT_EQ(frames[1].sensor_celsius.size(), 3U);
  EXPECT_TRUE(std::isnan(frames[1].sensor_celsius[1]));
  EXPECT_EQ(frames[1].temperature_celsius, 21.0) << "the mean of those that read";
}

TEST(TextLayout, each_head_with_temperatures_replaces_those_before_it) {
  const std::string one = std::string(kTwoByTwo) + "line = [\"T {temperature}\", \"{values}\"]\n";
  const auto frames = frames_of(one, bytes_of("T 20\nT 21\nT 22\n1 2 3 4\nT 23\n5 6 7 8\n"));
  ASSERT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[0].temperature_celsius, 22.0);
  EXPECT_EQ(frames[1].temperature_celsius, 23.0);
  for (const RawFrame& frame : frames) EXPECT_TRUE(frame.sensor_celsius.empty()) << "there is one sensor";

  const std::string two = std::string(kTwoByTwo) + "line = [\"T {temperature} {temperature}\", \"{values}\"]\n";
  const auto pairs = frames_of(two, bytes_of("T 20 30\nT 21 31\nT 22 32\n1 2 3 4\nT 23 33\n5 6 7 8\n"));
  ASSERT_EQ(readings_of(pairs), kOneToEight);
  EXPECT_EQ(pairs[0].sensor_celsius, (std::vector<float>{22.0F, 32.0F}));
  EXPECT_EQ(pairs[0].temperature_celsius, 27.0);
  EXPECT_EQ(pairs[1].sensor_celsius, (std::vector<float>{23.0F, 33.0F}));
}

TEST(TextLayout, the_temperature_of_a_line_replaces_that_of_its_head) {
  const auto frames =
      frames_of(std::string(kTwoByTwo) + "line = [\"T {temperature}\", \"{temperature}C {values}\", \"{values}\"]\n",
                bytes_of("T 20\n25C 1 2 3 4\n5 6 7 8\n"));
  ASSERT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[0].temperature_celsius, 25.0);
  EXPECT_TRUE(frames[0].sensor_celsius.empty());
  EXPECT_EQ(frames[1].temperature_celsius, 20.0);
}

TEST(TextLayout, a_temperature_beyond_float_is_no_reading) {
  const auto pairs = frames_of(std::string(kTwoByTwo) + "line = \"{temperature} {temperature}: {values}\"\n",
                               bytes_of("1e300 20: 1 2 3 4\n20 -1e300: 5 6 7 8\n"));
  ASSERT_EQ(readings_of(pairs), kOneToEight);
  EXPECT_TRUE(std::isnan(pairs[0].sensor_celsius[0]));
  EXPECT_EQ(pairs[0].temperature_celsius, 20.0);
  EXPECT_TRUE(std::isnan(pairs[1].sensor_celsius[1]));
  EXPECT_EQ(pairs[1].temperature_celsius, 20.0);
  const auto one = frames_of(std::string(kTwoByTwo) + "line = \"{temperature}: {values}\"\n",
                             bytes_of("1e300: 1 2 3 4\n20: 5 6 7 8\n"));
  ASSERT_EQ(readings_of(one), kOneToEight);
  EXPECT_EQ(one[0].temperature_celsius, std::nullopt);
}

TEST(TextLayout, a_clock_goes_on_over_midnight_and_a_date_counts_from_1970) {
  const std::string clock = std::string(kTwoByTwo) + "line = \"{clock} {values}\"\n";
  const auto night = frames_of(clock, bytes_of("23:59:59.500 1 2 3 4\n00:00:00,500 5 6 7 8\n"));
  ASSERT_EQ(night.size(), 2U);
  EXPECT_EQ(*night[1].acquisition.device_time - *night[0].acquisition.device_time, std::chrono::seconds(1));
  const auto dated = frames_of(std::string(kTwoByTwo) + "line = \"{datetime},{values}\"\n",
                               bytes_of("1970-01-02T00:00:01.25Z,1,2,3,4\n"));
  ASSERT_EQ(dated.size(), 1U);
  EXPECT_EQ(dated[0].acquisition.device_time, Nanos(86'401'250'000'000));
}

TEST(TextLayout, late_frames_are_put_in_order) {
  const std::string toml = std::string(kTwoByTwo) + "line = \"{time_ms} {frame} {values}\"\n";
  const auto frames =
      frames_of(toml, bytes_of("0 0 0 0 0 0\n40 2 5 6 7 8\n60 3 1 1 1 1\n20 1 1 2 3 4\n80 4 2 2 2 2\n"));
  EXPECT_EQ(readings_of(frames), (Readings{{0, 0, 0, 0}, {1, 2, 3, 4}, {5, 6, 7, 8}, {1, 1, 1, 1}, {2, 2, 2, 2}}));
  for (const RawFrame& frame : frames) EXPECT_EQ(frame.acquisition.lost_before, 0U);
}

TEST(TextLayout, a_frame_that_is_put_in_order_ends_where_its_own_bytes_end) {
  const auto decoder =
      make_decoder(layout_of(std::string(kTwoByTwo) + "line = \"{time_ms} {frame} {values}\"\n"), 0, true);
  decoder->push(bytes_of("0 0 0 0 0 0\n40 2 5 6 7 8\n20 1 1 2 3 4\n"));
  decoder->finish();
  RawFrame frame;
  std::vector<std::uint64_t> ends;
  while (decoder->next(frame)) ends.push_back(decoder->frame_end());
  EXPECT_EQ(ends, (std::vector<std::uint64_t>{12, 38, 25}));
}

TEST(TextLayout, late_frames_are_counted_and_a_live_reader_drops_them) {
  const auto layout = layout_of(std::string(kTwoByTwo) + "line = \"{time_ms} {frame} {values}\"\n");
  const Bytes bytes = bytes_of("0 0 0 0 0 0\n40 2 5 6 7 8\n20 1 1 2 3 4\n60 3 1 1 1 1\n5000 4 2 2 2 2\n10 5 3 3 3 3\n");
  const auto live = make_decoder(layout, 0, false);
  EXPECT_EQ(readings_of(frames_of(*live, bytes)),
            (Readings{{0, 0, 0, 0}, {5, 6, 7, 8}, {1, 1, 1, 1}, {2, 2, 2, 2}, {3, 3, 3, 3}}))
      << "more than a second back is a restart";
  EXPECT_EQ(live->counts(), (DecoderCounts{.frames = 5, .lost_frames = 1, .late_frames = 1}));
  const auto waiting = make_decoder(layout, 0, true);
  EXPECT_EQ(frames_of(*waiting, bytes).size(), 6U);
  EXPECT_EQ(waiting->counts(), (DecoderCounts{.frames = 6, .late_frames = 1}));
}

TEST(TextLayout, a_frame_that_is_sent_again_is_dropped_and_one_that_only_looks_so_is_not) {
  const auto layout = layout_of(std::string(kTwoByTwo) + "line = \"{frame}: {values}\"\n");
  const auto decoder = make_decoder(layout, 0, false);
  EXPECT_EQ(readings_of(frames_of(*decoder, bytes_of("1: 1 2 3 4\n1: 1 2 3 4\n2: 1 2 3 4\n2: 5 6 7 8\n"))),
            (Readings{{1, 2, 3, 4}, {1, 2, 3, 4}, {5, 6, 7, 8}}));
  EXPECT_EQ(decoder->counts().repeated_frames, 1U);
}

TEST(TextLayout, frames_that_the_device_calls_corrupt_are_dropped_and_absent_ones_have_no_readings) {
  const std::string toml =
      std::string(kTwoByTwo) + "line = \"{values} {flags}\"\nflags.corrupt = [4, 6]\nflags.absent = [2]\n";
  const auto decoder = make_decoder(layout_of(toml), 0, true);
  const auto frames = frames_of(*decoder, bytes_of("1 2 3 4 0\n0 0 0 0 6\n9 9 9 9 2\n5 6 7 8 1\n"));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(std::isnan(frames[1].counts[0]));
  EXPECT_EQ(decoder->counts().damaged_frames, 1U);
}

TEST(TextLayout, a_head_says_whose_and_when_the_lines_behind_it_are) {
  const std::string keys = "line = [\"Frame {frame} at {time_ms} ms\", \"T={temperature}\", \"{values}\"]\n";
  const std::vector<RawFrame> frames =
      frames_of(kTwoByTwo + keys,
                bytes_of("Frame 7 at 20 ms\n1 2\nT=21.5\n3 4\nFrame 9 at 40 ms\n5 6 7 8\nFrame 10 at 60 ms\n9 9\n"));
  EXPECT_EQ(readings_of(frames), kOneToEight);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].acquisition.sequence, 9U);
  EXPECT_EQ(frames[1].acquisition.lost_before, 1U);
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::milliseconds(40));
  EXPECT_EQ(frames[0].temperature_celsius, std::nullopt);
  EXPECT_EQ(frames[1].temperature_celsius, 21.5);
}

TEST(TextLayout, a_head_cuts_the_frame_that_lacks_rows) {
  EXPECT_EQ(readings_of("line = [\"FRAME\", \"{values}\"]\n", "FRAME\n1 2\n3 4\nFRAME\n9 9\nFRAME\n5 6\n7 8\n"),
            kOneToEight);
}

TEST(TextLayout, arrays_have_lines_or_heads_of_their_own) {
  const std::string arrays =
      "[[layout.array]]\nname = \"left\"\nrows = 2\ncols = 2\n[[layout.array]]\nname = \"right\"\nrows = 1\ncols = 2\n";
  const std::string own = "[layout]\nline = [\"L {left}\", \"R {right}\"]\n" + arrays;
  const Bytes lines = bytes_of("L 1 2 3 4\nR 7 7\nL 5 6 7 8\nR 8 8\n");
  EXPECT_EQ(readings_of(frames_of(own, lines, 0)), kOneToEight);
  EXPECT_EQ(readings_of(frames_of(own, lines, 1)), (Readings{{7, 7}, {8, 8}}));
  const std::string heads = "[layout]\nline = [\"sensor {array}\", \"{values}\"]\n" + arrays;
  const Bytes rows = bytes_of("sensor left\n1 2\n3 4\nsensor right\n7 7\nsensor left\n5 6\n7 8\n");
  EXPECT_EQ(readings_of(frames_of(heads, rows, 0)), kOneToEight);
  EXPECT_EQ(readings_of(frames_of(heads, rows, 1)), (Readings{{7, 7}}));
}

TEST(TextLayout, fields_of_readings_share_those_of_a_line) {
  EXPECT_EQ(readings_of("line = \"R0: {values} | R1: {values}\"\n", "R0: 1 2 | R1: 3 4\nR0: 5 6 | R1: 7 8\n"),
            kOneToEight);
  EXPECT_EQ(readings_of("line = \"{row},{value},{skip},{value}\"\n", "0,1,x,2\n1,3,x,4\n0,5,x,6\n1,7,x,8\n"),
            kOneToEight);
  EXPECT_EQ(error_of(std::string(kTwoByTwo) + "line = \"{value} a {value} b {value}\"\n"),
            "it.toml:4: layout.line: 3 fields of readings cannot share those of a frame");
}

TEST(TextLayout, a_line_may_show_that_a_frame_begins) {
  EXPECT_EQ(
      readings_of("line = \"{values}\"\nframe_begin = \"[[\"\n", " [9 9]]\n[[1 2]\n [3 4]]\n[[9 9]\n[[5 6]\n [7 8]]\n"),
      kOneToEight);
}

TEST(TextLayout, seconds_and_smaller_units_add_up) {
  const std::string heads = "line = [\"sec: {time_s}\", \"nsec: {time_ns}\", \"{values}\"]\n";
  const auto frames = frames_of(kTwoByTwo + heads, bytes_of("sec: 2\nnsec: 7\n1 2 3 4\nsec: 3\nnsec: 8\n5 6 7 8\n"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].acquisition.device_time, std::chrono::nanoseconds(2'000'000'007));
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::nanoseconds(3'000'000'008));
  const auto zoned = frames_of(std::string(kTwoByTwo) + "line = \"{datetime},{values}\"\n",
                               bytes_of("1970-01-01T02:30:05+02:30,1,2,3,4\n"));
  ASSERT_EQ(zoned.size(), 1U);
  EXPECT_EQ(zoned[0].acquisition.device_time, std::chrono::seconds(5));
}

TEST(TextLayout, parts_of_a_time_may_stand_in_either_order) {
  const auto frames = frames_of(std::string(kTwoByTwo) + "line = \"{time_ns},{time_s},{values}\"\n",
                                bytes_of("7,2,1 2 3 4\n9,3,5 6 7 8\n"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].acquisition.device_time, std::chrono::nanoseconds(2'000'000'007));
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::nanoseconds(3'000'000'009));
}

TEST(TextLayout, lines_may_be_parts_of_a_frame) {
  EXPECT_EQ(readings_of("line = \"{values x1}\"\n", "1\n2\n3\n4\n5\n6\n7\n8\n9\n"), kOneToEight);
  EXPECT_EQ(readings_of("line = \"{values x2}\"\n", "1 2\n3 4\n5 6\n7 8\n"), kOneToEight);
  EXPECT_EQ(readings_of("line = [\"1028\", \"{values x1}\"]\n", "9\n1028\n1\n2\n3\n4\n1028\n9\n1028\n5\n6\n7\n8\n"),
            kOneToEight);
  EXPECT_EQ(error_of(std::string(kTwoByTwo) + "line = \"{values x5}\"\n"),
            "it.toml:4: layout.line: x is more than the array has taxels");
}

TEST(TextLayout, rows_and_counters_may_be_hexadecimal) {
  const std::string keys = "digits = \"hexadecimal\"\nwidth = 2\nline = ";
  EXPECT_EQ(readings_of(keys + "\"can0 2{row:2x}#{values}\"\n",
                        "can0 20A#0102\ncan0 200#0102\ncan0 201#0304\n"
                        "can0 200#0506\ncan0 201#0708\n"),
            kOneToEight);
  EXPECT_EQ(readings_of("line = \"{row-0x1F:x}: {values}\"\n", "1f: 1 2\n20: 3 4\n0x1F: 5 6\n0x20: 7 8\n"),
            kOneToEight);
  EXPECT_EQ(readings_of("line = \"{row:1x}{skip} {values}\"\n", "0a 1 2\n1b 3 4\n0c 5 6\n1d 7 8\n"), kOneToEight);
  const auto frames = frames_of(std::string(kTwoByTwo) + "line = \"{frame:x} {time_ms:x} {values}\"\n",
                                bytes_of("0a 64 1 2 3 4\n0C C8 5 6 7 8\n"));
  ASSERT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[1].acquisition.lost_before, 1U);
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::milliseconds(200));
}

TEST(TextLayout, absent_numbers_may_be_several_and_ranges) {
  const Readings readings = readings_of("line = \"{values}\"\nabsent = [65535, -1, [4090, 4095], 0]\n",
                                        "1 -1 65535 4089\n0 4090 4095 4096\n");
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0][0], 1.0F);
  EXPECT_EQ(readings[0][3], 4089.0F);
  EXPECT_EQ(readings[1][3], 4096.0F);
  for (const float value : {readings[0][1], readings[0][2], readings[1][0], readings[1][1], readings[1][2]})
    EXPECT_TRUE(std::isnan(value)) << value;
  EXPECT_NE(error_of(std::string(kTwoByTwo) + "line = \"{values}\"\nabsent = [[5, 1]]\n").find("[-1, [4090, 4095]]"),
            std::string::npos);
}

TEST(TextLayout, a_document_is_read_by_its_objects_or_lists) {
  EXPECT_EQ(
      readings_of(
          "line_end = \"}\"\nline = '{skip}\"data\": {values}'\n",
          "{\"rate\": 5, \"frames\": [\r\n {\"data\": [1,\r\n 2,\r\n 3, 4]},\n {\"data\": [[5, 6], [7,\n8]]\n}\n]}\n"),
      kOneToEight);
  EXPECT_EQ(readings_of("line_end = \"]\"\nframe_end = \"\"\nline = \"{skip}[{values}\"\n",
                        "[\n [\n  [1, 2],\n  [3, 4]\n ],\n [[5, 6], [7, 8]]\n]\n"),
            kOneToEight);
}

TEST(LayoutToml, what_a_device_is_sent_is_bytes) {
  const std::string keys = std::string(kTwoByTwo) + "line = \"{values}\"\n";
  const std::string bytes("\xAA\x01\0\xFF", 4);
  EXPECT_EQ(layout_of(keys + R"(start = "\xAA\x01\x00\xff" # as "\x41" of '\x42')" + "\n")->start, bytes);
  EXPECT_EQ(layout_of(keys + R"(start = "\u00AA\u0001\u0000\u00FF")" + "\n")->start, bytes);
  EXPECT_EQ(layout_of(keys + "request = [0xAA, 1, 0, 255]\n")->request, bytes);
  EXPECT_EQ(layout_of(keys + R"(start = "\\x41\n")" + "\n")->start, "\\x41\n");
  EXPECT_NE(error_of(keys + "start = [256]\n").find("layout.start: must be a text in quotes, or a list of bytes"),
            std::string::npos);
}

TEST(TextLayout, a_device_is_asked_before_each_frame_or_until_it_sends) {
  const auto layout = [](const char* key) { return layout_of(kTwoByTwo + std::string("line = \"{values}\"\n") + key); };
  const auto started = make_decoder(layout("start = \"go\""), 0, false);
  const auto asked = make_decoder(layout("request = \"a\""), 0, false);
  EXPECT_EQ(started->request(), "go");
  EXPECT_EQ(asked->request(), "a");
  for (Decoder* const decoder : {started.get(), asked.get()}) {
    RawFrame frame;
    decoder->push(bytes_of("1 2 3 4\n"));
    ASSERT_TRUE(decoder->next(frame));
  }
  EXPECT_EQ(started->request(), "");
  EXPECT_EQ(asked->request(), "a");
}

TEST(TextLayout, what_does_not_fit_is_no_reading) {
  EXPECT_EQ(readings_of("line = \"{values}\"\ncomment = \"#\"\n",
                        "a,b,c,d\n1 2 3 4\nDEBUG 17\n#1 2 3 4\n1 2 3\n1 2 3 4 5\n5 6 7 8\n5 6 7"),
            kOneToEight);
}

TEST(TextLayout, says_which_line_does_not_fit_and_where) {
  const auto decoder = make_decoder(layout_of(std::string(kTwoByTwo) + "line = \"{row}: {values}\"\n"), 0, true);
  EXPECT_TRUE(frames_of(*decoder, bytes_of("\n0: 1 x\n")).empty());
  EXPECT_EQ(decoder->advice(), "line 2 does not fit layout.line at 'x': a reading is expected");
}

TEST(TextLayout, cites_the_first_line_that_does_not_fit_and_the_first_behind_a_head) {
  const auto decoder = make_decoder(layout_of(std::string(kTwoByTwo) + "line = \"{row}: {values}\"\n"), 0, true);
  EXPECT_TRUE(frames_of(*decoder, bytes_of("row: a b\n0: 1\n1: 2\n")).empty());
  EXPECT_EQ(decoder->advice(),
            "line 1 does not fit layout.line at 'row: a b': a whole number is expected; "
            "line 2 does not fit layout.line at its end: more readings are expected");
}

TEST(PacketLayout, cites_the_byte_where_a_packet_came_furthest) {
  const auto advice_of = [](const std::string& keys, const Bytes& bytes) {
    const auto decoder = make_decoder(layout_of(kTwoByTwo + keys), 0, true);
    EXPECT_TRUE(frames_of(*decoder, bytes).empty());
    return decoder->advice();
  };
  EXPECT_EQ(
      advice_of("packet = [\"AA\", \"row u8\", \"values u8\", \"BB\"]\n", {9, 0xAA, 0, 1, 2, 3, 0xAA, 1, 3, 4, 5}),
      "byte 1: layout.packet[3] does not fit");
  EXPECT_EQ(advice_of("packet = [\"AA 55\", \"values u8\"]\n", {9, 9, 0xAA, 0x55, 1, 2, 3, 0xAA, 0x55, 1, 2, 3}),
            "the mark AA 55 of byte 2 does not come again after 6 bytes");
  EXPECT_EQ(advice_of("packet = [\"values u16be\"]\n", {1, 2, 3}), "they are less than the 8 bytes of a frame");
}

TEST(Layout, says_what_bytes_without_a_line_or_packet_lack) {
  const auto advice_of = [](const std::string& keys, const Bytes& bytes) {
    const auto decoder = make_decoder(layout_of(kTwoByTwo + keys), 0, false);
    RawFrame frame;
    decoder->push(bytes);
    EXPECT_FALSE(decoder->next(frame));
    return decoder->advice();
  };
  const std::string packet = "packet = [\"AA\", \"values u8\", \"checksum sum8\"]\n";
  EXPECT_EQ(advice_of(packet, {1, 2, 3}), "no packet is in them");
  EXPECT_EQ(advice_of(packet, {1, 2, 0xAA, 3}), "the packet at byte 2 does not end within 2 bytes");
  EXPECT_EQ(advice_of("line = \"{values}\"\n", bytes_of("1 2 3")),
            "no line ends in them: give layout.line_end, the byte that ends one");
  EXPECT_EQ(advice_of("line = \"{values}\"\n", bytes_of("\n\n")), "no line holds readings");
}

TEST(PacketLayout, a_packet_is_found_in_a_run_of_its_mark) {
  for (const char* checksum : {"sum8", "xor8", "crc8", "crc16be", "crc32be"}) {
    const auto layout = layout_of("[layout]\nrows = 8\ncols = 8\npacket = [\"AA\", \"values u8\", \"checksum " +
                                  std::string(checksum) + "\"]\n");
    const PacketField& field = std::get<PacketLayout>(layout->form).packets.front().back();
    Bytes packet(65, 0xAA);
    for (std::size_t k = 1; k < packet.size(); k += 2) packet[k] = static_cast<std::uint8_t>(k);
    const std::uint32_t sum = ChecksumOf(field.checksum, field.type.bits)(packet);
    for (unsigned shift = field.type.bits; shift > 0; shift -= 8)
      packet.push_back(static_cast<std::uint8_t>(sum >> (shift - 8)));
    Bytes bytes(1000, 0xAA);
    for (const std::size_t run : {0U, 1U, 64U, 70U}) {
      bytes.insert(bytes.end(), packet.begin(), packet.end());
      bytes.insert(bytes.end(), run, 0xAA);
    }
    const auto decoder = make_decoder(layout, 0, false);
    EXPECT_GE(frames_of(*decoder, bytes, 100).size(), 4U) << checksum;
    EXPECT_EQ(decoder->counts().skipped_bytes + decoder->counts().frames * packet.size(), bytes.size()) << checksum;
  }
}

TEST(TextLayout, several_arrays_in_a_line_or_in_turn_are_told_apart) {
  const std::string arrays =
      "[[layout.array]]\nname = \"l\"\nrows = 1\ncols = 2\nid = 1\n"
      "[[layout.array]]\nname = \"r\"\nrows = 1\ncols = 2\nid = 2\n";
  EXPECT_EQ(readings_of(frames_of("[layout]\nline = \"{r}|{l}\"\n" + arrays, bytes_of("1 2|3 4\n"))),
            (Readings{{3, 4}}));
  const std::string in_turn = "[layout]\nline = \"{array}:{values}\"\n" + arrays;
  const Bytes turns = bytes_of("1:1 2\n2:3 4\n1:5 6\n");
  EXPECT_EQ(readings_of(frames_of(in_turn, turns, 0)), (Readings{{1, 2}, {5, 6}}));
  EXPECT_EQ(readings_of(frames_of(in_turn, turns, 1)), (Readings{{3, 4}}));
}

TEST(PacketLayout, numbers_stand_in_either_order_and_any_width) {
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values u8\"]\n", {0xAA, 1, 2, 3, 4, 0xAA, 5, 6, 7, 8}), kOneToEight);
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values u16be\"]\n", {0xAA, 0, 1, 0, 2, 1, 0, 0, 4}),
            (Readings{{1, 2, 256, 4}}));
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values i16le\"]\n", {0xAA, 0xFF, 0xFF, 2, 0, 0, 0x80, 4, 0}),
            (Readings{{-1, 2, -32768, 4}}));
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values u12be\"]\n", {0xAA, 0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC}),
            (Readings{{0x123, 0x456, 0x789, 0xABC}}));
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values u12le\"]\n", {0xAA, 0x23, 0x61, 0x45, 0x89, 0xC7, 0xAB}),
            (Readings{{0x123, 0x456, 0x789, 0xABC}}));
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values u10le\"]\n", {0xAA, 0xFF, 0x03, 0x00, 0x00, 0x40}),
            (Readings{{0x3FF, 0, 0, 0x100}}));
  EXPECT_EQ(readings_of("packet = [\"AA\", \"values f32le\"]\n",
                        {0xAA, 0, 0, 0x80, 0x3F, 0, 0, 0, 0x40, 0, 0, 0x40, 0x40, 0, 0, 0x80, 0x40}),
            (Readings{{1, 2, 3, 4}}));
}

/// Published check values over "123456789".
TEST(PacketLayout, packets_of_one_size_may_end_with_their_mark_and_hold_it) {
  const Bytes at_end = {1, 2, 3, 4, 0xFF, 0xFE, 5, 6, 0xFF, 0xFE, 0xFF, 0xFE, 1, 2, 3, 4, 0xFF, 0xFE};
  EXPECT_EQ(readings_of("packet = [\"values u8\", \"FF FE\"]\n", at_end),
            (Readings{{1, 2, 3, 4}, {5, 6, 255, 254}, {1, 2, 3, 4}}));
  Bytes at_begin;
  Readings expected;
  for (int k = 0; k < 20; ++k) {
    const Bytes readings = {static_cast<std::uint8_t>(k), 255, 255, 255};
    at_begin.insert(at_begin.end(), {0xFF, 0xFF});
    at_begin.insert(at_begin.end(), readings.begin(), readings.end());
    expected.emplace_back(readings.begin(), readings.end());
  }
  EXPECT_EQ(readings_of("packet = [\"FF FF\", \"values u8\"]\n", at_begin), expected);
}

TEST(PacketLayout, bytes_that_never_change_show_where_a_packet_begins) {
  Bytes bytes;
  for (int k = 0; k < 8; ++k) bytes.insert(bytes.end(), {0x40, 0x40, 0x40, 0x40, 0x40, 0x0D});
  EXPECT_EQ(readings_of("packet = [\"40\", \"values u8\", \"0D\"]\n", bytes), Readings(8, {64, 64, 64, 64}));
}

TEST(PacketLayout, readings_may_stand_apart_and_beside_other_bits) {
  const Bytes apart = {0xA5, 1, 2, 0, 3, 4, 0xA5, 5, 6, 0, 7, 8};
  EXPECT_EQ(readings_of("packet = [\"A5\", \"values u8\", \"00\", \"values u8\"]\n", apart), kOneToEight);
  EXPECT_EQ(readings_of("packet = [\"A5\", \"values u8 x2\", \"skip 1\", \"values u8 x2\"]\n", apart), kOneToEight);
  const Bytes channels = {0xA5, 0x00, 1, 0x11, 2, 0x20, 3, 0x3F, 0xFF};
  EXPECT_EQ(readings_of("packet = [\"A5\", \"values u16be mask=0FFF\"]\n", channels), (Readings{{1, 258, 3, 4095}}));
  EXPECT_EQ(readings_of("packet = [\"A5\", \"values u16be mask=F000\"]\n", channels), (Readings{{0, 1, 2, 3}}));
  EXPECT_EQ(
      error_of(std::string(kTwoByTwo) + "packet = [\"A5\", \"values u8 mask=100\"]\n"),
      "it.toml:4: layout.packet: field 2: mask= must be hexadecimal digits of bits that a number without a sign has");
}

TEST(PacketLayout, checksums_have_the_check_values_of_their_catalogue) {
  const struct {
    const char* checksum;
    Bytes value;
  } known[] = {{"sum8", {0xDD}},
               {"xor8", {0x31}},
               {"crc8", {0xF4}},
               {"crc8-maxim", {0xA1}},
               {"crc16be", {0x29, 0xB1}},
               {"crc16-xmodemle", {0xC3, 0x31}},
               {"crc16-modbusbe", {0x4B, 0x37}},
               {"crc16-kermitbe", {0x21, 0x89}},
               {"crc32be", {0xCB, 0xF4, 0x39, 0x26}},
               {"sum16be", {0x01, 0xDD}},
               {"sum8 negated", {0x23}},
               {"crc16be poly=8005 init=0000 reflected", {0xBB, 0x3D}}};
  for (const auto& [checksum, value] : known) {
    const std::string keys =
        std::string("packet = [\"31 32 33 34 35\", \"values u8\", \"checksum ") + checksum + "\"]\n";
    Bytes bytes = bytes_of("123456789");
    bytes.insert(bytes.end(), value.begin(), value.end());
    EXPECT_EQ(readings_of(keys, bytes), (Readings{{'6', '7', '8', '9'}})) << checksum;
    bytes.back() ^= 1;
    EXPECT_TRUE(readings_of(keys, bytes).empty()) << checksum;
  }
}

TEST(PacketLayout, escapes_are_undone) {
  const std::string packet = "packet = [\"values u8\", \"checksum sum8\"]\nescape = ";
  EXPECT_EQ(readings_of(packet + "\"cobs\"\n", {1, 3, 1, 2, 2, 3, 0, 6, 1, 2, 3, 4, 10, 0}),
            (Readings{{0, 1, 2, 0}, {1, 2, 3, 4}}));
  EXPECT_EQ(readings_of(packet + "\"slip\"\n", {0xC0, 0xDB, 0xDC, 0xDB, 0xDD, 1, 2, 0x9E, 0xC0}),
            (Readings{{0xC0, 0xDB, 1, 2}}));
  EXPECT_EQ(readings_of(packet + "\"7E 7D 20\"\n", {0x7E, 0x7D, 0x5E, 0x7D, 0x5D, 1, 2, 0xFE, 0x7E}),
            (Readings{{0x7E, 0x7D, 1, 2}}));
}

TEST(PacketLayout, counters_and_clocks_go_on_where_they_wrap) {
  const auto frames = frames_of(std::string(kTwoByTwo) +
                                    "packet = [\"AA\", \"frame u8\", \"time_ms u16le\", "
                                    "\"temperature i16le *0.01\", \"values u8\"]\n",
                                {0xAA, 255, 0xFF, 0xFF, 0x66, 8, 1, 2, 3, 4, 0xAA, 2, 9, 0, 0x66, 8, 5, 6, 7, 8});
  ASSERT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[1].acquisition.lost_before, 2U);
  EXPECT_EQ(*frames[1].acquisition.device_time - *frames[0].acquisition.device_time, std::chrono::milliseconds(10));
  EXPECT_NEAR(*frames[0].temperature_celsius, 21.5, 1e-9);
}

TEST(PacketLayout, times_are_exact) {
  const std::string keys = R"(packet = ["AA 55", "time_ms u32be", "values u8", "checksum sum8"]
)";
  for (std::uint32_t time = UINT32_MAX - 100; time < UINT32_MAX; ++time) {
    const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(time >> shift); };
    Bytes packet = {0xAA, 0x55, byte(24), byte(16), byte(8), byte(0), 1, 2, 3, 4};
    packet.push_back(static_cast<std::uint8_t>(std::accumulate(packet.begin(), packet.end(), 0U)));
    const std::vector<RawFrame> frames = frames_of(kTwoByTwo + keys, packet);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].acquisition.device_time, std::chrono::milliseconds(time));
  }
}

TEST(PacketLayout, several_temperatures_are_those_of_sensors) {
  const auto frames = frames_of(std::string(kTwoByTwo) +
                                    "packet = [\"AA\", \"temperature i16le *0.01\", \"temperature i16le *0.01\", "
                                    "\"values u8\"]\n",
                                {0xAA, 0x66, 8, 0xCC, 16, 1, 2, 3, 4, 0xAA, 0x66, 8, 0x66, 8, 5, 6, 7, 8});
  ASSERT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[0].sensor_celsius, (std::vector<float>{21.5F, 43.0F}));
}

TEST(PacketLayout, a_frame_may_come_in_runs) {
  EXPECT_EQ(readings_of("packet = [\"AA\", \"first u8\", \"count u8\", \"values u8\"]\n",
                        {0xAA, 0, 3, 1, 2, 3, 0xAA, 3, 1, 4, 0xAA, 0, 4, 5, 6, 7, 8}),
            kOneToEight);
}

TEST(PacketLayout, a_run_may_reach_beyond_the_array) {
  const std::string keys = "packet = [\"AA\", \"first u8\", \"values u8 x3\", \"FF\"]\n";
  const Bytes bytes = {0xAA, 0, 1, 2, 3, 0xFF, 0xAA, 3, 4, 0, 0, 0xFF, 0xAA, 6, 0, 0, 0, 0xFF,
                       0xAA, 0, 5, 6, 7, 0xFF, 0xAA, 3, 8, 0, 0, 0xFF, 0xAA, 6, 0, 0, 0, 0xFF};
  const auto decoder = make_decoder(layout_of(kTwoByTwo + keys), 0, true);
  EXPECT_EQ(readings_of(frames_of(*decoder, bytes)), kOneToEight);
  EXPECT_EQ(decoder->counts().damaged_frames, 0U);
  Bytes counted = bytes;
  for (std::size_t at = 1; at < counted.size(); at += 6) counted[at] /= 3;
  EXPECT_EQ(readings_of("packet = [\"AA\", \"first u8 *3\", \"values u8 x3\", \"FF\"]\n", counted), kOneToEight);
}

TEST(PacketLayout, runs_of_a_frame_may_overlap) {
  const std::string keys = "packet = [\"AA\", \"first u8\", \"values u8 x3\", \"FF\"]\n";
  EXPECT_EQ(readings_of(keys, {0xAA, 0, 1, 2, 3, 0xFF, 0xAA, 1, 2, 3, 4, 0xFF,  //
                               0xAA, 0, 5, 6, 7, 0xFF, 0xAA, 1, 6, 7, 8, 0xFF}),
            kOneToEight);
  const Bytes without_a_beginning = {0xAA, 1, 2, 3, 4, 0xFF, 0xAA, 0, 5, 6, 7, 0xFF, 0xAA, 1, 6, 7, 8, 0xFF};
  EXPECT_EQ(readings_of(keys, without_a_beginning), (std::vector<std::vector<float>>{{5, 6, 7, 8}}));
}

TEST(TextLayout, rows_of_two_frames_are_never_one) {
  const std::string keys = "[layout]\nrows = 3\ncols = 1\nline = \"{row}: {values}\"\n";
  const auto frames = [&](const std::string& text) {
    const auto decoder = make_decoder(layout_of(keys), 0, true);
    return readings_of(frames_of(*decoder, Bytes(text.begin(), text.end())));
  };
  const Readings last = {{7, 8, 9}};
  EXPECT_EQ(frames("1: 2\n2: 3\n0: 4\n2: 6\n0: 7\n1: 8\n2: 9\n"), last);  // each first row but one is lost
  EXPECT_EQ(frames("1: 2\n2: 3\n0: 7\n1: 8\n2: 9\n"), last);  // the middle of a frame is the first that came
  EXPECT_EQ(frames("2: 9\n1: 8\n0: 7\n"), last);
}

TEST(PacketLayout, frames_of_one_size_need_no_mark) {
  const Bytes bytes = {0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7, 0, 8, 0};
  EXPECT_EQ(readings_of("packet = [\"values u16be\"]\n", bytes), kOneToEight);
  const auto frames =
      frames_of(std::string(kTwoByTwo) + "packet = [\"frame u8\", \"values u8\"]\n", {7, 1, 2, 3, 4, 9, 5, 6, 7, 8});
  EXPECT_EQ(readings_of(frames), kOneToEight);
  EXPECT_EQ(frames[1].acquisition.lost_before, 1U);
}

TEST(PacketLayout, a_frame_without_a_mark_begins_behind_a_pause) {
  const auto decoder = make_decoder(layout_of(std::string(kTwoByTwo) + "packet = [\"values u8\"]\n"), 0, false);
  RawFrame frame;
  decoder->push(Bytes{9, 9});
  EXPECT_FALSE(decoder->next(frame));
  decoder->idle();
  EXPECT_FALSE(decoder->next(frame));
  decoder->push(Bytes{1, 2, 3, 4});
  ASSERT_TRUE(decoder->next(frame));
  EXPECT_EQ(frame.counts, kOneToEight[0]);
  EXPECT_EQ(decoder->counts().skipped_bytes, 2U);
}

TEST(PacketLayout, codes_may_stand_for_bytes) {
  const std::string keys = "packet = [\"5B\", \"values u8\"]\nescape = \"5D 5C 00=5C 01=5B 02=5D\"\n";
  EXPECT_EQ(readings_of(
                keys, {0x5B, 1, 0x5C, 0, 0x5C, 1, 0x5C, 2, 0x5D, 0x5B, 1, 0x5C, 3, 3, 4, 0x5D, 0x5B, 5, 6, 7, 8, 0x5D}),
            (Readings{{1, 0x5C, 0x5B, 0x5D}, {5, 6, 7, 8}}));
  EXPECT_EQ(readings_of("packet = [\"values u8\", \"checksum sum8\"]\nescape = \"C0 DB DC=C0 DD=DB\"\n",
                        {0xC0, 0xDB, 0xDC, 0xDB, 0xDD, 1, 2, 0x9E, 0xC0}),
            (Readings{{0xC0, 0xDB, 1, 2}}))
      << "as SLIP";
  EXPECT_NE(
      error_of(std::string(kTwoByTwo) + "packet = [\"values u8\"]\nescape = \"5D 5C 00=\"\n").find("layout.escape"),
      std::string::npos);
}

TEST(PacketLayout, arrays_in_turn_may_differ_in_size) {
  const std::string toml =
      "[layout]\npacket = [\"AA\", \"array u8\", \"values u8\"]\n[[layout.array]]\nname = \"l\"\nrows = 1\ncols = 1\n"
      "id = 1\n[[layout.array]]\nname = \"r\"\nrows = 1\ncols = 3\nid = 2\n";
  const Bytes bytes = {0xAA, 1, 7, 0xAA, 2, 1, 2, 3, 0xAA, 1, 8, 0xAA, 2, 4, 5, 6};
  EXPECT_EQ(readings_of(frames_of(toml, bytes, 0)), (Readings{{7}, {8}}));
  EXPECT_EQ(readings_of(frames_of(toml, bytes, 1)), (Readings{{1, 2, 3}, {4, 5, 6}}));
}

TEST(PacketLayout, damaged_bytes_cost_no_more_than_their_frames) {
  const std::string toml = std::string(kTwoByTwo) + "packet = [\"AA 55\", \"values u8\", \"checksum xor8\"]\n";
  const Bytes one = {0xAA, 0x55, 1, 2, 3, 4, 0xFB};
  Bytes bytes;
  for (int k = 0; k < 20; ++k) bytes.insert(bytes.end(), one.begin(), one.end());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    Bytes damaged = bytes;
    damaged[at] ^= 0x10;
    EXPECT_GE(frames_of(toml, damaged).size(), 19U) << at;
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(at));
    EXPECT_GE(frames_of(toml, damaged).size(), 19U) << at;
  }
}

TEST(PacketLayout, packets_may_differ) {
  const std::string two = R"(packet = [["AA 01", "values u8", "checksum sum8"],
                                       ["AA 02", "values u16be", "checksum sum8"]]
)";
  const Bytes bytes = {0xAA, 1, 1, 2, 3, 4, 0xB5, 0xAA, 2, 0, 5, 0, 6, 0, 7, 0, 8, 0xC6};
  EXPECT_EQ(readings_of(two, bytes), kOneToEight);
  const std::string apart = R"(packet = [["AA 01", "values u8"], ["BB", "values u16be"]]
)";
  EXPECT_EQ(readings_of(apart, Bytes{0xAA, 1, 1, 2, 3, 4, 0xBB, 0, 5, 0, 6, 0, 7, 0, 8}), kOneToEight);
  const std::string escaped = R"(packet = [["01", "values u8"], ["02", "values u16be"]]
escape = "slip"
)";
  EXPECT_EQ(readings_of(escaped, Bytes{1, 1, 2, 3, 4, 0xC0, 2, 0, 5, 0, 6, 0, 7, 0, 8, 0xC0}), kOneToEight);
}

TEST(PacketLayout, the_distance_of_marks_tells_packets_that_differ_in_size) {
  const std::string keys = R"(packet = [["AA 55", "values u8"], ["AA 55", "values u8", "skip 1"]]
)";
  Bytes bytes;
  for (int k = 0; k < 6; ++k) bytes.insert(bytes.end(), {0xAA, 0x55, 1, 2, 3, 4, 9});
  EXPECT_EQ(readings_of(keys, bytes), Readings(6, {1, 2, 3, 4}));
}

TEST(PacketLayout, the_distance_of_marks_tells_packets_however_much_they_differ_in_size) {
  const std::string begin = "packet = [[\"AA 55\", \"values u8\"], [\"AA 55\", \"values u8\", \"skip 90\"]]\n";
  const std::string end = "packet = [[\"values u8\", \"AA 55\"], [\"values u8\", \"skip 90\", \"AA 55\"]]\n";
  const Bytes readings = {1, 2, 3, 4};
  const Bytes mark = {0xAA, 0x55};
  Bytes marked_first;
  Bytes marked_last;
  for (int k = 0; k < 6; ++k) {
    Bytes rest = readings;
    rest.resize(94, 9);
    marked_first.insert(marked_first.end(), mark.begin(), mark.end());
    marked_first.insert(marked_first.end(), rest.begin(), rest.end());
    marked_last.insert(marked_last.end(), rest.begin(), rest.end());
    marked_last.insert(marked_last.end(), mark.begin(), mark.end());
  }
  EXPECT_EQ(readings_of(begin, marked_first), Readings(6, {1, 2, 3, 4}));
  EXPECT_EQ(readings_of(end, marked_last), Readings(5, {1, 2, 3, 4}));
}

TEST(PacketLayout, a_clock_that_leaps_beyond_all_time_begins_anew) {
  const std::string keys = R"(packet = ["AA 55", "time_ms u32be", "values u8", "checksum sum8"]
)";
  Bytes bytes;
  for (std::uint32_t k = 0; k < 5000; ++k) {  // by 2^31 - 1 ms each: 2^63 ns are 4295 of them
    const std::uint32_t time = k * INT32_MAX;
    const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(time >> shift); };
    Bytes packet = {0xAA, 0x55, byte(24), byte(16), byte(8), byte(0), 1, 2, 3, 4};
    unsigned sum = 0;
    for (const std::uint8_t one : packet) sum += one;
    packet.push_back(static_cast<std::uint8_t>(sum));
    bytes.insert(bytes.end(), packet.begin(), packet.end());
  }
  const auto decoder = make_decoder(layout_of(kTwoByTwo + keys), 0, false);
  for (const RawFrame& frame : frames_of(*decoder, bytes)) ASSERT_GE(frame.acquisition.device_time, Nanos{});
  EXPECT_EQ(decoder->counts().frames, 5000U);
}

TEST(LayoutToml, stands_beside_the_array_that_it_is_of) {
  const Result<Layout> layout = layout_from_toml(
      "[array]\nname = \"mat\"\nrows = 2\ncols = 3\n[readout]\nadc_bits = 12\n[layout]\nline = \"{values}\"\n",
      "it.toml");
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->arrays.front().shape, (FrameShape{2, 3}));
}

TEST(LayoutToml, errors_name_the_line_the_key_and_the_mend) {
  const std::string two = kTwoByTwo;
  EXPECT_EQ(error_of(two), "it.toml: layout.line: give either line, for text, or packet, for bytes");
  EXPECT_EQ(error_of(two + "line = \"{vales}\"\n"),
            "it.toml:4: layout.line: 'vales' is no field; did you mean 'values'?");
  EXPECT_EQ(error_of(two + "line = \"{row}{values}\"\n"),
            "it.toml:4: layout.line: two fields need something between them, such as a comma");
  EXPECT_EQ(
      error_of(two + "packet = [\"FF\", \"values u16\"]\n"),
      "it.toml:4: layout.packet: field 2: 'u16' is no type: it is u8, i8, u10, u12, u16, i16, u24, u32, i32, u64, "
      "f32 or f64, then le where the low byte comes first or be where the high byte does");
  EXPECT_EQ(
      error_of(two + "packet = [\"row u8\", \"values u8\"]\n"),
      "it.toml:4: layout.packet: must begin or end with bytes that mark it, as \"FF FF\", have an escape, or be a "
      "whole frame that is always of one size");
  EXPECT_EQ(error_of(two + "packet = [[\"FF\", \"values u8\"], [\"EE\", \"vales u8\"]]\n"),
            "it.toml:4: layout.packet: packet 2: field 2: 'vales' is no field; did you mean 'values'?");
  EXPECT_EQ(error_of(two + "packet = [\"FF\", [\"values u8\"]]\n"),
            "it.toml:4: layout.packet: must be a list of texts in quotes");
  EXPECT_EQ(error_of("[layout]\nrows = 2\nline = \"{values}\"\n"),
            "it.toml: layout.cols: is missing; it has no default");
  EXPECT_NE(error_of(two + "line = \"{values}\"\nseperator = \";\"\n").find("did you mean 'layout.separator'?"),
            std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::layouts
