// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/frames_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <streambuf>

#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

Result<std::vector<RawFrame>> parse(const std::string& text, std::size_t rows = 1, std::size_t cols = 2,
                                    const std::string& name = "frames.csv") {
  const auto reader = FramesCsvReader::open(std::make_unique<std::istringstream>(text), name, FrameShape{rows, cols});
  if (!reader) return reader.error();
  return support::read_all(**reader);
}

std::string error_of(const std::string& text, std::size_t rows = 1, std::size_t cols = 2) {
  const Result<std::vector<RawFrame>> frames = parse(text, rows, cols);
  if (frames) return "no error";
  EXPECT_EQ(frames.error().kind, ErrorKind::bad_input);
  return frames.error().message;
}

std::string header_of(std::size_t rows, std::size_t cols) {
  std::string header = "time_s";
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      header += ",r" + std::to_string(row) + "c" + std::to_string(col);
    }
  }
  return header + "\n";
}

TEST(FramesCsvReader, reads_all_columns) {
  const auto frames = parse("time_s,temperature_celsius,supply_v,r0c0,r0c1\n0.25,21.5,4.98,100,4095\n");
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 1U);
  const RawFrame& frame = frames->front();
  EXPECT_EQ(frame.time, std::chrono::milliseconds(250));
  EXPECT_EQ(frame.temperature_celsius, 21.5);
  EXPECT_EQ(frame.supply_v, 4.98);
  EXPECT_EQ(frame.counts, (std::vector<float>{100.0F, 4095.0F}));
}

TEST(FramesCsvReader, takes_the_other_columns_in_any_order) {
  const auto frames = parse("supply_v,time_s,r0c0,r0c1\n5,1,2,3\n");
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->front().supply_v, 5.0);
  EXPECT_EQ(frames->front().time, std::chrono::seconds(1));
  EXPECT_EQ(frames->front().temperature_celsius, std::nullopt);
}

TEST(FramesCsvReader, reads_an_empty_cell_as_no_value) {
  const auto frames = parse("time_s,temperature_celsius,supply_v,r0c0,r0c1\n0,20,5,1,2\n1,,,3,4\n");
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->back().temperature_celsius, std::nullopt);
  EXPECT_EQ(frames->back().supply_v, std::nullopt);
}

TEST(FramesCsvReader, keeps_fractions_and_what_is_not_finite) {
  const auto frames = parse("time_s,supply_v,r0c0,r0c1\n0,nan,1.5,nan\n1,inf,NaN,inf\n");
  ASSERT_TRUE(frames);
  EXPECT_EQ((*frames)[0].counts[0], 1.5F);
  EXPECT_TRUE(std::isnan((*frames)[0].counts[1]));
  EXPECT_TRUE(std::isnan((*frames)[0].supply_v.value()));
  EXPECT_TRUE(std::isnan((*frames)[1].counts[0]));
  EXPECT_EQ((*frames)[1].counts[1], std::numeric_limits<float>::infinity());
}

TEST(FramesCsvReader, reads_an_empty_cell_of_a_taxel_as_a_missing_reading) {
  const auto frames = parse("time_s,r0c0,r0c1\n0,,2\n1,1,\n");
  ASSERT_TRUE(frames) << frames.error().message;
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_TRUE(std::isnan((*frames)[0].counts[0]));
  EXPECT_EQ((*frames)[0].counts[1], 2.0F);
  EXPECT_TRUE(std::isnan((*frames)[1].counts[1]));
}

TEST(FramesCsvReader, reads_times_to_the_nanosecond) {
  const auto frames = parse(
      header_of(1, 1) + "1731412345.123456789,0\n-0.000000001,0\n1e-3,0\n0.30000000000000004,0\n" + "9000000000,0\n", 1,
      1);
  ASSERT_TRUE(frames);
  EXPECT_EQ((*frames)[0].time.count(), 1'731'412'345'123'456'789);
  EXPECT_EQ((*frames)[1].time.count(), -1);
  EXPECT_EQ((*frames)[2].time.count(), 1'000'000);
  EXPECT_EQ((*frames)[3].time.count(), 300'000'000);
  EXPECT_EQ((*frames)[4].time.count(), 9'000'000'000'000'000'000);
}

TEST(FramesCsvReader, takes_byte_order_mark_crlf_blanks_blank_lines_and_a_last_line_without_end) {
  const auto frames = parse("\xEF\xBB\xBFtime_s , r0c0,r0c1\r\n 0 ,\t1, 2 \r\n\r\n1,3,4");
  ASSERT_TRUE(frames) << frames.error().message;
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_EQ(frames->front().counts, (std::vector<float>{1.0F, 2.0F}));
  EXPECT_EQ(frames->back().counts, (std::vector<float>{3.0F, 4.0F}));
}

TEST(FramesCsvReader, takes_a_file_with_a_header_only) {
  const auto frames = parse("time_s,r0c0,r0c1\n");
  ASSERT_TRUE(frames);
  EXPECT_TRUE(frames->empty());
}

TEST(FramesCsvReader, tells_the_line_of_the_last_frame) {
  const auto reader = FramesCsvReader::open(std::make_unique<std::istringstream>("time_s,r0c0\n0,1\n\n1,2\n"),
                                            "frames.csv", FrameShape{1, 1});
  ASSERT_TRUE(reader);
  RawFrame frame;
  EXPECT_EQ((*reader)->place(), "frames.csv:1");
  ASSERT_TRUE((*reader)->next(frame));
  EXPECT_EQ((*reader)->place(), "frames.csv:2");
  ASSERT_TRUE((*reader)->next(frame));
  EXPECT_EQ((*reader)->place(), "frames.csv:4");
}

TEST(FramesCsvReader, refuses_an_empty_file) {
  EXPECT_EQ(error_of(""), "frames.csv:1: is empty; expected a header time_s,r0c0,...");
  EXPECT_EQ(error_of("\n \n"), "frames.csv:2: is empty; expected a header time_s,r0c0,...");
}

TEST(FramesCsvReader, names_the_first_missing_column) {
  EXPECT_EQ(error_of("r0c0,r0c1\n"), "frames.csv:1: column time_s is missing; the header begins with time_s");
  EXPECT_EQ(error_of("time_s,r0c0\n"), "frames.csv:1: has 1x1 taxels, the array is 1x2");
  EXPECT_EQ(error_of("time_s,r0c0,r1c1\n", 2, 2), "frames.csv:1: column r0c1 is missing; the array is 2x2");
  EXPECT_EQ(error_of("time_s\n"), "frames.csv:1: column r0c0 is missing; the array is 1x2");
}

TEST(FramesCsvReader, names_both_sizes_where_the_array_is_another) {
  EXPECT_EQ(error_of(header_of(12, 10), 16, 16), "frames.csv:1: has 12x10 taxels, the array is 16x16");
  EXPECT_EQ(error_of(header_of(32, 32), 16, 16), "frames.csv:1: has 32x32 taxels, the array is 16x16");
}

std::string learning_error_of(const std::string& text) {
  const auto reader = FramesCsvReader::open(std::make_unique<std::istringstream>(text), "frames.csv");
  return reader ? "no error" : reader.error().message;
}

TEST(FramesCsvReader, learns_the_shape_from_the_last_column) {
  const auto reader = FramesCsvReader::open(std::make_unique<std::istringstream>(header_of(3, 2)), "frames.csv");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ((*reader)->shape(), (FrameShape{3, 2}));
}

TEST(FramesCsvReader, refuses_a_header_from_which_no_shape_can_be_learnt) {
  EXPECT_EQ(learning_error_of("time_s\n"),
            "frames.csv:1: its last column is 'time_s', not a taxel; the header ends with r0c0,...");
  EXPECT_EQ(learning_error_of("time_s,r0c0,x\n"),
            "frames.csv:1: its last column is 'x', not a taxel; the header ends with r0c0,...");
  EXPECT_EQ(learning_error_of("time_s,r0c0,r1c1\n"), "frames.csv:1: column r0c1 is missing; its last column says 2x2");
  EXPECT_EQ(learning_error_of("time_s,r1024c0\n"),
            "frames.csv:1: its last column is 'r1024c0'; at most 1024x1024 taxels can be read");
  EXPECT_EQ(learning_error_of("time_s,r0c18446744073709551615\n"),
            "frames.csv:1: its last column is 'r0c18446744073709551615'; at most 1024x1024 taxels can be read");
}

TEST(FramesCsvReader, names_an_unknown_column) {
  EXPECT_EQ(error_of("time_s,humidity,r0c0,r0c1\n"),
            "frames.csv:1: unknown column 'humidity'; before r0c0 stand time_s, temperature_celsius, "
            "sensor0_celsius and so on, and supply_v");
  EXPECT_EQ(error_of("time_s,r0c0,x,r0c1\n"), "frames.csv:1: unknown column 'x'; expected r0c1");
  EXPECT_EQ(error_of("time_s,r0c0,r0c1,x\n"),
            "frames.csv:1: unknown column 'x' after the last taxel of a 1x2 array; remove it");
}

TEST(FramesCsvReader, names_what_another_table_holds) {
  EXPECT_EQ(error_of("time_s,status,r0c0,r0c1\n"), "frames.csv:1: is a table of forces, not of raw counts");
  EXPECT_EQ(error_of("time_s,status,total_n,sigma_total_n,left_out\n"),
            "frames.csv:1: is a table of total forces, not of raw counts");
  EXPECT_EQ(learning_error_of("time_s,id,phase,x_mm\n"), "frames.csv:1: is a table of contacts, not of raw counts");
  EXPECT_EQ(learning_error_of("frame,kind,where,value\n"), "frames.csv:1: is a table of loads, not of raw counts");
}

TEST(FramesCsvReader, names_a_column_out_of_place) {
  EXPECT_EQ(error_of("time_s,r0c1,r0c0\n"),
            "frames.csv:1: column 'r0c1' stands where r0c0 is expected; write the taxels row by row, after all other "
            "columns");
  EXPECT_EQ(error_of("time_s,r0c0,supply_v,r0c1\n"),
            "frames.csv:1: column 'supply_v' stands where r0c1 is expected; write the taxels row by row, after all "
            "other columns");
  EXPECT_EQ(error_of("time_s,time_s,r0c0,r0c1\n"), "frames.csv:1: column 'time_s' stands twice; remove one");
}

TEST(FramesCsvReader, says_what_another_program_has_saved) {
  using namespace std::string_literals;  // NOLINT(google-build-using-namespace): the literals only
  EXPECT_EQ(error_of("time_s;r0c0;r0c1\n"),
            "frames.csv:1: has semicolons between its values; write commas, and decimals with a point");
  EXPECT_EQ(error_of("time_s\tr0c0\tr0c1\n"), "frames.csv:1: has tabs between its values; write commas");
  EXPECT_EQ(error_of("\"time_s\",\"r0c0\",\"r0c1\"\n"),
            "frames.csv:1: has quotes around its values; write them without");
  for (const std::string& mark : {"\xFF\xFE"s, "\xFE\xFF"s, ""s}) {
    EXPECT_EQ(error_of(mark + "t\0i\0m\0e\0_\0s\0,\0"s), "frames.csv:1: is UTF-16 text; save it as UTF-8");
  }
}

TEST(FramesCsvReader, loses_only_the_last_line_where_it_is_cut) {
  const std::string whole = "time_s,r0c0,r0c1\n0,1,2\n1,3,4\n";
  for (const std::string rest : {"2", "2,", "2,5", "2,5,6,7", "2,5,x"}) {
    std::vector<std::string> notices;
    const auto reader =
        FramesCsvReader::open(std::make_unique<std::istringstream>(whole + rest), "frames.csv", FrameShape{1, 2},
                              [&](const std::string& line) { notices.push_back(line); });
    ASSERT_TRUE(reader);
    const auto frames = support::read_all(**reader);
    ASSERT_TRUE(frames) << frames.error().message;
    EXPECT_EQ(frames->size(), 2U) << rest;
    EXPECT_EQ(notices, std::vector<std::string>{"frames.csv:4: is cut off; the frames before are read"});
    EXPECT_FALSE(parse(whole + rest + "\n")) << "a line that is wrong is not cut";
  }
  EXPECT_EQ(parse(whole + "2,5,6")->size(), 3U) << "a last line needs no end";
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,1"), "frames.csv:2: has 2 values, the header 3");
}

TEST(FramesCsvReader, names_both_lengths_of_a_ragged_row) {
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,1,2\n1,1\n"), "frames.csv:3: has 2 values, the header 3");
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,1,2,\n"), "frames.csv:2: has 4 values, the header 3");
}

TEST(FramesCsv, names_decimals_that_are_written_with_a_comma) {
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,5,1,2\n"),
            "frames.csv:2: has 4 values, the header 3: write decimals with a point, as each comma begins a value");
}

TEST(FramesCsvReader, names_column_and_text_that_is_not_a_number) {
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,1,x2\n"),
            "frames.csv:2: column r0c1: 'x2' is not a number; leave the cell empty where a reading is missing");
  EXPECT_EQ(error_of("time_s,supply_v,r0c0,r0c1\n0,5V,1,2\n"),
            "frames.csv:2: column supply_v: '5V' is not a number; leave the cell empty where there is no value");
  EXPECT_EQ(error_of("time_s,r0c0,r0c1\n0,1,\x01\x7F\n"),
            "frames.csv:2: column r0c1: '\?\?' is not a number; leave the cell empty where a reading is missing");
}

TEST(FramesCsvReader, refuses_a_time_that_is_no_number_or_too_far) {
  for (const std::string time : {"", "now", "nan", "inf", "1e10", "-9000000001"}) {
    EXPECT_EQ(error_of("time_s,r0c0,r0c1\n" + time + ",1,2\n"),
              "frames.csv:2: column time_s: '" + time + "' is not a time; write seconds of at most 9e9");
  }
}

/// Endless zeros, as from /dev/zero.
class EndlessBuffer : public std::streambuf {
 protected:
  std::streamsize xsgetn(char* bytes, std::streamsize count) override {
    std::fill_n(bytes, count, '0');
    return count;
  }
};

TEST(FramesCsvReader, refuses_an_endless_line) {
  EndlessBuffer buffer;
  const auto reader = FramesCsvReader::open(std::make_unique<std::istream>(&buffer), "frames.csv", FrameShape{1, 1});
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message, "frames.csv:1: is longer than 32 MiB; one frame or load belongs on each line");
}

TEST(FramesCsvReader, names_a_path_that_cannot_be_opened) {
  const support::TemporaryFolder folder;
  const auto missing = FramesCsvReader::open(folder.file("x"));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(missing.error().message, "cannot open '" + folder.file("x") + "': No such file or directory");
  const auto directory = FramesCsvReader::open("/");
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().message, "cannot open '/': Is a directory");
}

TEST(FramesCsvReader, gives_a_value_or_a_one_line_error_for_mutations) {
  std::string text = "time_s,temperature_celsius,supply_v,r0c0,r0c1,r1c0,r1c1\r\n";
  for (int i = 0; i < 5; ++i) text += "0.5,20.25,,1,2.5,nan,4095\r\n";
  support::expect_value_or_one_line_error(text, 5000, [](const std::string& t) { return parse(t, 2, 2, "mutated"); });
}

RawFrame random_csv_frame(Random& random, std::size_t taxels) {
  RawFrame frame;
  frame.time = Nanos(static_cast<std::int64_t>(random.bits() >> 2U) - (std::int64_t{1} << 61U));
  if (random.below(2) == 0) frame.temperature_celsius = random.uniform(-40.0, 80.0);
  if (random.below(2) == 0) frame.supply_v = random.log_uniform(1e-9, 1e9);
  for (std::size_t i = 0; i < taxels; ++i) {
    const auto whole = static_cast<float>(random.below(1U << 24U));
    frame.counts.push_back(random.below(2) == 0 ? whole : static_cast<float>(random.log_uniform(1e-30, 1e30)));
  }
  return frame;
}

TEST(FramesCsvWriter, writes_what_reads_back_equal) {
  const support::TemporaryFolder folder;
  Random random(1);
  std::vector<RawFrame> frames;
  for (int i = 0; i < 300; ++i) frames.push_back(random_csv_frame(random, 12));
  const auto writer = FramesCsvWriter::create(folder.file("f.csv"), {3, 4});
  ASSERT_TRUE(writer);
  for (const RawFrame& frame : frames) ASSERT_TRUE((*writer)->write(frame));
  ASSERT_TRUE((*writer)->commit());
  const auto reader = FramesCsvReader::open(folder.file("f.csv"));
  ASSERT_TRUE(reader) << reader.error().message;
  const auto read = support::read_all(**reader);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ((*read)[i].time, frames[i].time);
    EXPECT_EQ((*read)[i].temperature_celsius, frames[i].temperature_celsius);
    EXPECT_EQ((*read)[i].supply_v, frames[i].supply_v);
    EXPECT_EQ((*read)[i].counts, frames[i].counts);
  }
}

TEST(FramesCsvWriter, writes_only_the_columns_asked_for) {
  const support::TemporaryFolder folder;
  const auto writer =
      FramesCsvWriter::create(folder.file("f.csv"), {1, 2}, {.temperature_celsius = false, .supply_v = true});
  ASSERT_TRUE(writer);
  ASSERT_TRUE((*writer)->write({std::chrono::milliseconds(-1500), 20.0, 5.0, {1.0F, -std::nanf("")}}));
  ASSERT_TRUE((*writer)->write({std::chrono::seconds(2), 20.0, std::nullopt, {0.5F, 4095.0F}}));
  ASSERT_TRUE((*writer)->commit());
  EXPECT_EQ(support::read_bytes(folder.file("f.csv")), "time_s,supply_v,r0c0,r0c1\n-1.5,5,1,nan\n2,,0.5,4095\n");
}

TEST(FramesCsvWriter, temperatures_of_several_sensors_read_back_equal) {
  const support::TemporaryFolder folder;
  const auto writer = FramesCsvWriter::create(folder.file("f.csv"), {1, 2});
  ASSERT_TRUE(writer);
  RawFrame frame{Nanos(0), 20.5, 5.0, {1.0F, 2.0F}};
  frame.sensor_celsius = {20.25F, std::nanf(""), -3.1F};
  ASSERT_TRUE((*writer)->write(frame));
  ASSERT_TRUE((*writer)->commit());
  EXPECT_EQ(support::read_bytes(folder.file("f.csv")),
            "time_s,temperature_celsius,sensor0_celsius,sensor1_celsius,sensor2_celsius,supply_v,r0c0,r0c1\n"
            "0,20.5,20.25,,-3.1,5,1,2\n");
  const auto reader = FramesCsvReader::open(folder.file("f.csv"));
  ASSERT_TRUE(reader) << reader.error().message;
  RawFrame read;
  ASSERT_TRUE((*reader)->next(read));
  ASSERT_EQ(read.sensor_celsius.size(), 3U);
  EXPECT_EQ(read.sensor_celsius[0], 20.25F);
  EXPECT_TRUE(std::isnan(read.sensor_celsius[1]));
  EXPECT_EQ(read.sensor_celsius[2], -3.1F);
  EXPECT_EQ(read.supply_v, 5.0);
}

TEST(FramesCsvReader, sensors_are_numbered_from_0_on) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("f.csv"), "time_s,sensor1_celsius,r0c0\n0,20,1\n");
  const auto reader = FramesCsvReader::open(folder.file("f.csv"));
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("sensor0_celsius is expected"), std::string::npos) << reader.error().message;
}

TEST(FramesCsvReader, more_sensors_than_an_array_can_have_are_refused) {
  std::string header = "time_s";
  for (int sensor = 0; sensor < 1025; ++sensor) header += ",sensor" + std::to_string(sensor) + "_celsius";
  EXPECT_EQ(error_of(header + ",r0c0,r0c1\n"),
            "frames.csv:1: has 1025 sensors of temperature; at most 1024, or one a taxel, can be read");
}

TEST(FramesCsvReader, the_largest_array_may_have_one_sensor_a_taxel) {
  std::string text = "time_s";
  for (std::size_t i = 0; i < std::size_t{1024} * 1024; ++i) text += ",sensor" + std::to_string(i) + "_celsius";
  append_taxel_names(text, 1024, 1024);
  text += "\n0";
  for (std::size_t i = 0; i < std::size_t{2} * 1024 * 1024; ++i) text += ",7";
  const auto reader = FramesCsvReader::open(std::make_unique<std::istringstream>(text + "\n"), "frames.csv");
  ASSERT_TRUE(reader) << reader.error().message;
  RawFrame frame;
  const Result<bool> more = (*reader)->next(frame);
  ASSERT_TRUE(more) << more.error().message;
  EXPECT_EQ(frame.sensor_celsius, std::vector<float>(std::size_t{1024} * 1024, 7.0F));
}

TEST(FramesCsvWriter, columns_of_sensors_that_the_first_frame_lacks_may_be_asked_for) {
  const support::TemporaryFolder folder;
  const auto writer = FramesCsvWriter::create(folder.file("f.csv"), {1, 1}, {.supply_v = false, .sensors = 2});
  ASSERT_TRUE(writer);
  RawFrame frame{Nanos(0), 20.5, {}, {1.0F}};
  ASSERT_TRUE((*writer)->write(frame));
  frame.sensor_celsius = {20.0F, 21.0F};
  ASSERT_TRUE((*writer)->write(frame));
  ASSERT_TRUE((*writer)->commit());
  EXPECT_EQ(support::read_bytes(folder.file("f.csv")),
            "time_s,temperature_celsius,sensor0_celsius,sensor1_celsius,r0c0\n0,20.5,,,1\n0,20.5,20,21,1\n");
}

TEST(FramesCsvWriter, reports_a_full_disk) {
  const auto writer = FramesCsvWriter::create("/dev/full", {1, 1});
  ASSERT_TRUE(writer);
  static_cast<void>((*writer)->write({Nanos(0), {}, {}, {1.0F}}));
  const Status committed = (*writer)->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().message, "cannot write '/dev/full': No space left on device");
}

}  // namespace
}  // namespace dermis::bytes::files
