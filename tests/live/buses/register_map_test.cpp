// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/register_map.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

namespace dermis::live::buses {
namespace {

RegisterMap map_of(const std::string& arrays, const std::string& keys = "") {
  return *register_map_from_toml("[registers]\n" + keys + "\narray = [" + arrays + "]\n", "map.toml");
}

std::vector<float> decoded(const std::string& array, const std::vector<std::uint16_t>& words) {
  RawFrame frame;
  decode_registers(map_of("{name = \"a\", address = 0, " + array + "}").arrays.front(), words, frame);
  return frame.counts;
}

std::vector<std::size_t> all_of(const RegisterMap& map) {
  std::vector<std::size_t> all(map.arrays.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

TEST(RegisterMap, every_known_map_can_be_read) {
  for (const std::string& name : known_register_maps()) EXPECT_TRUE(read_register_map(name)) << name;
}

TEST(RegisterMap, the_hand_of_inspire_has_17_regions_of_1062_taxels_without_a_gap) {
  const Result<RegisterMap> hand = read_register_map("inspire-rh56");
  ASSERT_TRUE(hand);
  ASSERT_EQ(hand->arrays.size(), 17U);
  std::size_t address = 3000;
  std::size_t taxels = 0;
  for (const RegisterArray& array : hand->arrays) {
    EXPECT_EQ(array.address, address) << array.name;
    address += 2 * array.words();
    taxels += array.shape.taxel_count();
  }
  EXPECT_EQ(taxels, 1062U);
  EXPECT_EQ(hand->port, 6000);
}

TEST(RegisterMap, the_array_of_dfrobot_has_its_last_row_first) {
  const Result<RegisterMap> map = read_register_map("dfrobot-sen0705");
  ASSERT_TRUE(map);
  EXPECT_TRUE(map->input);
  std::vector<std::uint16_t> words(32);
  std::iota(words.begin(), words.end(), std::uint16_t{0});
  RawFrame frame;
  decode_registers(map->arrays.front(), words, frame);
  EXPECT_EQ(frame.counts.front(), 24.0F);
  EXPECT_EQ(frame.counts.back(), 7.0F);
}

TEST(RegisterMap, readings_are_whole_or_floats_of_one_or_two_words) {
  EXPECT_EQ(decoded("rows = 1, cols = 2", {1, 0xFFFF}), (std::vector<float>{1.0F, 65535.0F}));
  EXPECT_EQ(decoded("rows = 1, cols = 2, value = \"i16\"", {1, 0xFFFF}), (std::vector<float>{1.0F, -1.0F}));
  EXPECT_EQ(decoded("rows = 1, cols = 1, value = \"u32\"", {1, 2}), (std::vector<float>{65538.0F}));
  EXPECT_EQ(decoded("rows = 1, cols = 1, value = \"u32\", low_word_first = true", {2, 1}),
            (std::vector<float>{65538.0F}));
  EXPECT_EQ(decoded("rows = 1, cols = 1, value = \"i32\"", {0xFFFF, 0xFFFE}), (std::vector<float>{-2.0F}));
  EXPECT_EQ(decoded("rows = 1, cols = 1, value = \"f32\"", {0x3FC0, 0}), (std::vector<float>{1.5F}));
}

TEST(RegisterMap, readings_have_an_order_a_scale_and_an_offset) {
  EXPECT_EQ(decoded("rows = 2, cols = 3, order = \"columns\"", {0, 1, 2, 3, 4, 5}),
            (std::vector<float>{0, 2, 4, 1, 3, 5}));
  EXPECT_EQ(decoded("rows = 1, cols = 2, scale = -0.5, offset = 10.0", {2, 4}), (std::vector<float>{9.0F, 8.0F}));
}

TEST(RegisterMap, neighbours_are_read_together_and_large_arrays_in_pieces) {
  const RegisterMap hand = *read_register_map("inspire-rh56");
  const std::vector<RegisterRead> reads = plan_reads(hand, all_of(hand));
  ASSERT_EQ(reads.size(), 11U);
  EXPECT_EQ(reads[0].address, 3000);
  EXPECT_EQ(reads[0].words, 105U);
  EXPECT_EQ(reads[0].parts[1].array, 1U);
  EXPECT_EQ(reads[0].parts[1].read_begin, 9U);
  EXPECT_EQ(reads.back().address, 4900);
  EXPECT_EQ(reads.back().words, 112U);

  const std::vector<std::size_t> palm{16};
  EXPECT_EQ(plan_reads(hand, palm).size(), 1U);

  const RegisterMap mat = map_of("{name = \"mat\", address = 100, rows = 16, cols = 16}");
  const std::vector<RegisterRead> pieces = plan_reads(mat, all_of(mat));
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[1].address, 225);
  EXPECT_EQ(pieces[2].words, 6U);
  EXPECT_EQ(pieces[2].parts.front().array_begin, 250U);
}

TEST(RegisterMap, errors_name_the_line_and_the_key) {
  const auto error = [](const std::string& text) { return register_map_from_toml(text, "m.toml").error().message; };
  EXPECT_EQ(error("[registers]\n"), "m.toml: registers.array: there must be 1 to 256");
  EXPECT_EQ(error("[registers]\narray = [{name = \"a\", rows = 0, cols = 1, address = 0}]\n"),
            "m.toml:2: registers.array[0].rows: must be 1 to 1024");
  EXPECT_EQ(error("[registers]\narray = [{name = \"a\", rows = 9, cols = 9, address = 65500}]\n"),
            "m.toml:2: registers.array[0].address: the array ends behind address 65535");
  EXPECT_EQ(read_register_map("inspire-rh5").error().message, "map=inspire-rh5: did you mean 'inspire-rh56'?");
  EXPECT_NE(read_register_map("x").error().message.find("known are dfrobot-sen0704, "), std::string::npos);
}

}  // namespace
}  // namespace dermis::live::buses
