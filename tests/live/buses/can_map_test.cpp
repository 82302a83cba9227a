// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/can_map.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace dermis::live::buses {
namespace {

using Taken = CanAssembly::Taken;

CanArray array_of(const std::string& keys) {
  const Result<CanMap> map = can_map_from_toml("[[can.array]]\nname = \"a\"\n" + keys, "map.toml");
  if (!map) ADD_FAILURE() << map.error().message;
  return map ? map->arrays.front() : CanArray{.name = "none", .shape = {1, 1}};
}

std::string error_of(const std::string& keys) {
  const Result<CanMap> map = can_map_from_toml("[[can.array]]\nname = \"a\"\n" + keys, "map.toml");
  return map ? "no error" : map.error().message;
}

TEST(CanMap, every_known_map_can_be_read_and_names_its_hands) {
  for (const std::string& name : known_can_maps()) EXPECT_TRUE(read_can_map(name)) << name;
  const Result<CanMap> hand = read_can_map("linkerhand-23x9-left");
  ASSERT_TRUE(hand);
  ASSERT_EQ(hand->arrays.size(), 6U);
  EXPECT_EQ(hand->arrays.front().shape, (FrameShape{23, 9}));
  EXPECT_EQ(hand->arrays.back().shape, (FrameShape{28, 20}));
  EXPECT_EQ(hand->arrays.back().id, 0x28U);
}

TEST(CanMap, an_unknown_name_is_told_the_nearest) {
  EXPECT_EQ(read_can_map("linkerhand-12x6-rigth").error().message,
            "map=linkerhand-12x6-rigth: did you mean 'linkerhand-12x6-right'?");
}

TEST(CanMap, rows_stand_in_a_nibble) {
  CanAssembly assembly(read_can_map("linkerhand-10x4-right")->arrays.front());
  EXPECT_EQ(assembly.take({0x27, {0xB1, 0xA4}}), Taken::nothing);  // the question
  EXPECT_EQ(assembly.take({0x27, {0xB2, 0x00, 1, 2, 3, 4}}), Taken::nothing);
  EXPECT_EQ(assembly.take({0x28, {0xB1, 0x00, 1, 2, 3, 4}}), Taken::nothing);
  std::vector<float> expected;
  for (std::uint8_t row = 0; row < 10; ++row) {
    const auto at = static_cast<std::uint8_t>(4 * row);
    const CanFrame frame{0x27,
                         {0xB1, static_cast<std::uint8_t>(row << 4U), at, static_cast<std::uint8_t>(at + 1),
                          static_cast<std::uint8_t>(at + 2), static_cast<std::uint8_t>(at + 3)}};
    EXPECT_EQ(assembly.take(frame), row == 9 ? Taken::frame : Taken::part);
  }
  expected.resize(40);
  std::iota(expected.begin(), expected.end(), 0.0F);
  EXPECT_EQ(assembly.counts(), expected);
  EXPECT_EQ(assembly.take({0x27, {0xB1, 0xA0, 1, 2, 3, 4}}), Taken::nothing);  // row 10 of 10
}

TEST(CanMap, parts_begin_at_a_row_and_a_column_and_go_on_over_rows) {
  CanAssembly assembly(read_can_map("linkerhand-23x9-right")->arrays.front());
  for (std::uint8_t part = 0; part < 42; ++part) {
    const auto begin = static_cast<std::size_t>(5 * part);
    CanFrame frame{0x27, {0xB1, static_cast<std::uint8_t>(begin / 9), static_cast<std::uint8_t>(begin % 9)}};
    for (std::size_t k = begin; k < std::min<std::size_t>(begin + 5, 207); ++k) {
      frame.data.push_back(static_cast<std::uint8_t>(k));
    }
    EXPECT_EQ(assembly.take(frame), part == 41 ? Taken::frame : Taken::part);
  }
  EXPECT_EQ(assembly.counts().back(), 206.0F);
  EXPECT_EQ(assembly.take({0x27, {0xB1, 0xFF, 1, 2, 3, 4, 5, 6}}), Taken::nothing);  // sums
}

TEST(CanMap, identifiers_count_the_parts_column_by_column) {
  CanAssembly assembly(
      array_of("id = 0x310\nrows = 6\ncols = 12\npart = \"identifier\"\neach = 8\norder = \"columns\"\n"));
  for (std::uint32_t part = 0; part < 9; ++part) {
    CanFrame frame{0x310 + part, {}};
    for (std::uint32_t k = 0; k < 8; ++k) frame.data.push_back(static_cast<std::uint8_t>(8 * part + k));
    EXPECT_EQ(assembly.take(frame), part == 8 ? Taken::frame : Taken::part);
  }
  EXPECT_EQ(assembly.counts()[0], 0.0F);
  EXPECT_EQ(assembly.counts()[1], 6.0F);
  EXPECT_EQ(assembly.counts()[12], 1.0F);
  EXPECT_EQ(assembly.take({0x319, std::vector<std::uint8_t>(8)}), Taken::nothing);
}

TEST(CanMap, readings_have_two_bytes_or_are_floats) {
  CanAssembly words(array_of("id = 5\nrows = 2\ncols = 2\nvalue = \"i16be\"\nlast_row_first = true\nscale = 2.0\n"));
  EXPECT_EQ(words.take({5, {0, 1, 0xFF, 0xFF, 1, 0, 0, 3}}), Taken::frame);
  EXPECT_EQ(words.counts(), (std::vector<float>{512, 6, 2, -2}));
  CanAssembly floats(array_of("id = 5\nrows = 1\ncols = 2\nvalue = \"f32le\"\n"));
  EXPECT_EQ(floats.take({5, {0, 0, 0xC0, 0x3F, 0, 0, 0, 0x40}}), Taken::frame);
  EXPECT_EQ(floats.counts(), (std::vector<float>{1.5F, 2.0F}));
}

TEST(CanMap, a_frame_without_all_its_parts_is_counted_and_left_out) {
  CanAssembly assembly(array_of("id = 5\nrows = 2\ncols = 2\nrow = \"byte 0\"\n"));
  EXPECT_EQ(assembly.take({5, {0, 1, 2}}), Taken::part);
  EXPECT_EQ(assembly.take({5, {0, 5, 6}}), Taken::part);
  EXPECT_EQ(assembly.take({5, {1, 7}}), Taken::nothing);  // cut
  EXPECT_EQ(assembly.take({5, {1, 7, 8}}), Taken::frame);
  EXPECT_EQ(assembly.counts(), (std::vector<float>{5, 6, 7, 8}));
  EXPECT_EQ(assembly.incomplete(), 1U);
}

TEST(CanMap, a_first_part_behind_the_last_one_begins_the_next_frame) {
  CanAssembly assembly(array_of("id = 5\nrows = 3\ncols = 1\nrow = \"byte 0\"\n"));
  for (const unsigned row : {1U, 2U, 0U, 1U}) {
    EXPECT_EQ(assembly.take({5, std::vector<std::uint8_t>(2, static_cast<std::uint8_t>(row))}), Taken::part);
  }
  EXPECT_EQ(assembly.take({5, {2, 9}}), Taken::frame);
  EXPECT_EQ(assembly.counts(), (std::vector<float>{0, 1, 9}));
  EXPECT_EQ(assembly.incomplete(), 1U);
}

TEST(CanMap, names_what_is_wrong) {
  EXPECT_EQ(error_of("id = 5\nrows = 2\ncols = 2\nrow = \"bit 3\"\n"),
            "map.toml:6: can.array[0].row: must be \"byte 1\", \"high nibble 1\", \"low nibble 1\" or \"identifier\"");
  EXPECT_NE(error_of("id = 5\nrows = 2\ncols = 2\nbegins = \"B\"\n").find("hexadecimal"), std::string::npos);
  EXPECT_NE(error_of("id = 5\nrows = 2\ncols = 2\npart = \"byte 0\"\n").find("each"), std::string::npos);
  EXPECT_NE(error_of("id = 5\nrows = 2\ncols = 2\ncol = \"byte 0\"\n").find("needs a row"), std::string::npos);
  EXPECT_NE(error_of("id = 0x20000000\nrows = 2\ncols = 2\n").find("can.array[0].id"), std::string::npos);
  EXPECT_NE(error_of("rows = 2\ncols = 2\n").find("can.array[0].id"), std::string::npos);
  EXPECT_FALSE(can_map_from_toml("[can]\n", "map.toml"));
}

}  // namespace
}  // namespace dermis::live::buses
