// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/loads_csv.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "dermis/touch/frames/random.hpp"
#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kFrames = 30;
constexpr const char* kHeader = "frame,kind,where,value\n";

ArrayDescription test_array() {
  ArrayDescription array;
  array.rows = array.cols = 16;
  array.taxel_area_m2 = 38.48e-6;
  return array;
}

Result<std::vector<Load>> parse(const std::string& text, const ArrayDescription& array = test_array(),
                                const std::string& name = "loads.csv") {
  std::istringstream in(text);
  return read_loads(in, name, array, kFrames);
}

/// Of the line after the header.
std::string error_of(const std::string& line) {
  const Result<std::vector<Load>> loads = parse(kHeader + line);
  if (loads) return "no error";
  EXPECT_EQ(loads.error().kind, ErrorKind::bad_input);
  return loads.error().message;
}

TEST(LoadsCsv, reads_force_and_pressure_on_taxel_region_and_all) {
  const auto loads = parse(std::string(kHeader) + "0,force,all,0\r\n7,force,r3c5,9.81\n7,pressure,r0c0:r2c3,20.5");
  ASSERT_TRUE(loads) << loads.error().message;
  ASSERT_EQ(loads->size(), 3U);
  EXPECT_EQ((*loads)[0].where, (TaxelRegion{0, 0, 15, 15}));
  EXPECT_EQ((*loads)[1].frame, 7U);
  EXPECT_EQ((*loads)[1].kind, LoadKind::force);
  EXPECT_EQ((*loads)[1].where, (TaxelRegion{3, 5, 3, 5}));
  EXPECT_EQ((*loads)[1].value, 9.81);
  EXPECT_EQ((*loads)[2].kind, LoadKind::pressure);
  EXPECT_EQ((*loads)[2].where, (TaxelRegion{0, 0, 2, 3}));
  EXPECT_DOUBLE_EQ((*loads)[2].value, 20500.0);
}

TEST(LoadsCsv, keeps_the_order_of_the_lines) {
  const auto loads = parse(std::string(kHeader) + "9,force,r0c0,1\n2,force,r0c0,2\n9,force,r0c1,3\n");
  ASSERT_TRUE(loads);
  EXPECT_EQ((*loads)[0].value, 1.0);
  EXPECT_EQ((*loads)[1].value, 2.0);
  EXPECT_EQ((*loads)[2].value, 3.0);
}

TEST(LoadsCsv, refuses_another_header) {
  const auto other = parse("frame,where,kind,value\n");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message,
            "loads.csv:1: has the header 'frame,where,kind,value'; expected frame,kind,where,value");
  const auto empty = parse("");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().message, "loads.csv:1: is empty; expected the header frame,kind,where,value");
}

TEST(LoadsCsv, refuses_a_line_of_another_length) {
  EXPECT_EQ(error_of("0,force,r0c0"), "loads.csv:2: has 3 values, the header 4");
}

TEST(LoadsCsv, refuses_a_frame_that_does_not_exist) {
  EXPECT_EQ(error_of("30,force,all,0"), "loads.csv:2: frame 30 does not exist; there are 30 frames, counted from 0");
  EXPECT_EQ(error_of("-1,force,all,0"), "loads.csv:2: frame '-1' is not a whole number of 0 or more");
  EXPECT_EQ(error_of("99999999999999999999,force,all,0"),
            "loads.csv:2: frame '99999999999999999999' is not a whole number of 0 or more");
}

TEST(LoadsCsv, refuses_an_unknown_kind) {
  EXPECT_EQ(error_of("0,weight,all,0"), "loads.csv:2: unknown kind 'weight'; write force, pressure or position");
}

TEST(LoadsCsv, refuses_a_pressure_without_taxel_area) {
  ArrayDescription array = test_array();
  array.taxel_area_m2.reset();
  const auto loads = parse(std::string(kHeader) + "0,pressure,all,20", array);
  ASSERT_FALSE(loads);
  EXPECT_EQ(loads.error().message,
            "loads.csv:2: a pressure needs array.taxel_area_mm2 in the description of the array");
}

TEST(LoadsCsv, refuses_a_place_that_is_none) {
  for (const std::string place : {"", "r3", "c3r3", "r-1c0", "r0c0 r1c1", "everything", "r1.5c0", "r0x0"}) {
    EXPECT_EQ(error_of("0,force," + place + ",1"),
              "loads.csv:2: '" + place + "' is not a place; write r3c5, r0c0:r3c3 or all");
  }
}

TEST(LoadsCsv, refuses_a_taxel_that_does_not_exist) {
  EXPECT_EQ(error_of("0,force,r16c3,1"), "loads.csv:2: r16c3 does not exist in a 16x16 array");
  EXPECT_EQ(error_of("0,force,r0c0:r3c16,1"), "loads.csv:2: r3c16 does not exist in a 16x16 array");
}

TEST(LoadsCsv, refuses_a_reversed_region) {
  EXPECT_EQ(error_of("0,force,r3c0:r0c3,1"),
            "loads.csv:2: region 'r3c0:r0c3' is reversed; write its smallest row and column first");
}

TEST(LoadsCsv, refuses_a_value_that_is_no_load) {
  EXPECT_EQ(error_of("0,force,all,1lb"),
            "loads.csv:2: value '1lb' is no force; write newtons, or a unit as in 2 N, 200 g or 0.2 kg");
  for (const std::string value : {"-1", "nan", "inf"}) {
    EXPECT_EQ(error_of("0,force,all," + value), "loads.csv:2: value '" + value + "' must be 0 to 1000000 (N or kPa)");
  }
  EXPECT_EQ(error_of("0,pressure,all,1e308"), "loads.csv:2: value '1e308' must be 0 to 1000000 (N or kPa)");
}

TEST(LoadsCsv, takes_the_unit_of_the_column_where_a_force_has_none_and_says_so) {
  for (const char* const column : {"kg", "value_kg"}) {
    std::istringstream in("frame,kind,where," + std::string(column) +
                          "\n0,force,all,0\n1,force,all,0.5\n2,force,all,3 N\n");
    std::string taken;
    const auto loads = read_loads(in, "loads.csv", test_array(), 3, &taken);
    ASSERT_TRUE(loads) << loads.error().message;
    EXPECT_DOUBLE_EQ((*loads)[1].value, 4.903325);
    EXPECT_DOUBLE_EQ((*loads)[2].value, 3.0);
    EXPECT_EQ(taken, "0.5 kg, taken for 4.903325 N");
  }
}

TEST(LoadsCsv, says_nothing_of_newtons) {
  std::istringstream in("frame,kind,where,value\n0,force,all,2\n");
  std::string taken;
  ASSERT_TRUE(read_loads(in, "loads.csv", test_array(), 3, &taken));
  EXPECT_EQ(taken, "");
}

TEST(LoadsCsv, refuses_loads_that_share_a_taxel_and_names_both_lines) {
  EXPECT_EQ(error_of("4,force,r0c0:r1c1,1\n5,force,r1c1,1\n4,pressure,r1c1:r2c2,1\n"),
            "loads.csv:4: overlaps line 2 at r1c1 of frame 4; name each taxel once per frame");
  EXPECT_EQ(error_of("4,force,r0c0,1\n4,force,all,1\n"),
            "loads.csv:3: overlaps line 2 at r0c0 of frame 4; name each taxel once per frame");
}

ArrayDescription test_strip() {
  ArrayDescription array = test_array();
  array.rows = 1;
  array.cols = 7;
  return array;
}

Result<std::vector<TouchPosition>> parse_positions(const std::string& lines, const ArrayDescription& array) {
  std::istringstream in(kHeader + lines);
  return read_touch_positions(in, "loads.csv", array, kFrames);
}

TEST(LoadsCsv, keeps_loads_and_positions_of_a_strip_apart) {
  const std::string lines = "5,position,all,12.5\n5,force,all,2\n3,position,all,-0.5\n0,force,all,0\n";
  const auto positions = parse_positions(lines, test_strip());
  ASSERT_TRUE(positions) << positions.error().message;
  ASSERT_EQ(positions->size(), 2U);
  EXPECT_EQ((*positions)[0].frame, 3U);
  EXPECT_DOUBLE_EQ((*positions)[0].along_m, -0.0005);
  EXPECT_EQ((*positions)[1].frame, 5U);
  EXPECT_DOUBLE_EQ((*positions)[1].along_m, 0.0125);
  const auto loads = parse(kHeader + lines, test_strip());
  ASSERT_TRUE(loads) << loads.error().message;
  ASSERT_EQ(loads->size(), 2U);
  EXPECT_EQ((*loads)[0].frame, 5U);
}

TEST(LoadsCsv, refuses_positions_that_are_none) {
  const auto refused = [](const std::string& lines, const ArrayDescription& array) {
    const auto positions = parse_positions(lines, array);
    return positions ? "" : positions.error().message;
  };
  EXPECT_EQ(refused("0,position,all,3", test_array()),
            "loads.csv:2: a position is a place along an array of one row or one column; this one is 16x16");
  EXPECT_EQ(refused("0,position,r0c3,3", test_strip()), "loads.csv:2: a position is one of the whole strip; write all");
  EXPECT_EQ(refused("0,position,all,nan", test_strip()), "loads.csv:2: value 'nan' is not a position in mm");
  EXPECT_EQ(refused("0,position,all,1\n0,position,all,1\n", test_strip()),
            "loads.csv:3: frame 0 has a position already; write one");
}

TEST(LoadsCsv, names_a_path_that_cannot_be_opened) {
  const auto loads = read_loads("/no/such/file", test_array(), 1);
  ASSERT_FALSE(loads);
  EXPECT_EQ(loads.error().message, "cannot open '/no/such/file': No such file or directory");
}

TEST(LoadsCsv, gives_a_value_or_a_one_line_error_for_mutations) {
  const std::string text = std::string(kHeader) + "0,force,all,0\n1,force,r0c0,5\n1,pressure,r1c0:r3c2,20\n";
  support::expect_value_or_one_line_error(
      text, 5000, [](const std::string& mutation) { return parse(mutation, test_array(), "mutated"); });
}

TEST(LoadsCsv, writes_what_reads_back_equal) {
  const support::TemporaryFolder folder;
  Random random(1);
  std::vector<Load> loads;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    const auto row = static_cast<std::size_t>(random.below(16));
    const auto col = static_cast<std::size_t>(random.below(16));
    const LoadKind kind = random.below(2) == 0 ? LoadKind::force : LoadKind::pressure;
    loads.push_back({frame, kind, {row / 2, col / 2, row, col}, random.log_uniform(1e-3, 1e6)});
  }
  loads[3].where = all_taxels(test_array());
  ASSERT_TRUE(write_loads(folder.file("l.csv"), test_array(), loads));
  const auto read = read_loads(folder.file("l.csv"), test_array(), kFrames);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    EXPECT_EQ((*read)[i].frame, loads[i].frame);
    EXPECT_EQ((*read)[i].kind, loads[i].kind);
    EXPECT_EQ((*read)[i].where, loads[i].where);
    EXPECT_DOUBLE_EQ((*read)[i].value, loads[i].value);
  }
}

TEST(LoadsCsv, writes_the_documented_form) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_loads(folder.file("l.csv"), test_array(),
                          {{0, LoadKind::force, {0, 0, 15, 15}, 0.0},
                           {1, LoadKind::force, {3, 5, 3, 5}, 9.81},
                           {1, LoadKind::pressure, {0, 0, 2, 3}, 20500.0}}));
  EXPECT_EQ(support::read_bytes(folder.file("l.csv")),
            std::string(kHeader) + "0,force,all,0\n1,force,r3c5,9.81\n1,pressure,r0c0:r2c3,20.5\n");
}

}  // namespace
}  // namespace dermis::bytes::files
