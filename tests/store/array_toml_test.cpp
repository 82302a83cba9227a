// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/store/array_toml.hpp"

#include <gtest/gtest.h>

#include "store/mutations.hpp"
#include "store/temporary_folder.hpp"

namespace dermis::store {
namespace {

constexpr const char* kComplete = R"([array]
name = "chest"
rows = 2
cols = 3
pitch_mm = [10.0, 12.5]
taxel_area_mm2 = 38.48

[readout]
circuit = "divider"
idle_rows = "floating"
drive_ohm = [20.0, 21.0]
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 3.3
supply_v = 5.0
pressure_raises_reading = false
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kComplete;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

std::string error_of(const std::string& text) {
  const Result<ArrayDescription> array = array_from_toml(text, "array.toml");
  if (array) return "no error";
  EXPECT_EQ(array.error().kind, ErrorKind::bad_input);
  return array.error().message;
}

TEST(ArrayToml, reads_every_key) {
  const Result<ArrayDescription> array = array_from_toml(kComplete, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->name, "chest");
  EXPECT_EQ(array->rows, 2U);
  EXPECT_EQ(array->cols, 3U);
  EXPECT_EQ(array->row_pitch_m, 0.010);
  EXPECT_EQ(array->col_pitch_m, 0.0125);
  EXPECT_EQ(array->taxel_area_m2, 38.48e-6);
  const Readout& readout = array->readout;
  EXPECT_EQ(readout.circuit, Circuit::divider);
  EXPECT_EQ(readout.idle_rows, IdleRows::floating);
  EXPECT_EQ(readout.drive_ohm, (std::vector<double>{20.0, 21.0}));
  EXPECT_EQ(readout.load_ohm, (std::vector<double>(3, 200.0)));
  EXPECT_EQ(readout.adc_bits, 12);
  EXPECT_EQ(readout.adc_reference_v, 3.3);
  EXPECT_EQ(readout.supply_v, 5.0);
  EXPECT_FALSE(readout.pressure_raises_reading);
}

TEST(ArrayToml, takes_defaults_from_the_struct) {
  const Result<ArrayDescription> array =
      array_from_toml("[array]\nrows = 4\ncols = 4\n[readout]\ncircuit = \"none\"\nadc_bits = 10\n", "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  const ArrayDescription defaults;
  EXPECT_EQ(array->name, defaults.name);
  EXPECT_EQ(array->row_pitch_m, defaults.row_pitch_m);
  EXPECT_EQ(array->col_pitch_m, defaults.col_pitch_m);
  EXPECT_EQ(array->taxel_area_m2, std::nullopt);
  EXPECT_EQ(array->readout.idle_rows, IdleRows::grounded);
  EXPECT_EQ(array->readout.adc_reference_v, std::nullopt);
  EXPECT_EQ(array->readout.supply_v, std::nullopt);
  EXPECT_TRUE(array->readout.pressure_raises_reading);
  EXPECT_TRUE(array->readout.drive_ohm.empty());
}

TEST(ArrayToml, takes_supply_as_adc_reference) {
  const Result<ArrayDescription> array = array_from_toml(with("= 3.3", "= \"supply\""), "array.toml");
  ASSERT_TRUE(array);
  EXPECT_EQ(array->readout.adc_reference_v, std::nullopt);
}

TEST(ArrayToml, requires_size_circuit_resolution_and_resistors) {
  EXPECT_EQ(error_of(with("rows = 2\n", "")), "array.toml: array.rows: is missing; it has no default");
  EXPECT_EQ(error_of(with("cols = 3\n", "")), "array.toml: array.cols: is missing; it has no default");
  EXPECT_EQ(error_of(with("circuit = \"divider\"\n", "")),
            "array.toml: readout.circuit: is missing; it has no default");
  EXPECT_EQ(error_of(with("adc_bits = 12\n", "")), "array.toml: readout.adc_bits: is missing; it has no default");
  EXPECT_EQ(error_of(with("load_ohm = 200.0\n", "")), "array.toml: readout.load_ohm: is missing; it has no default");
  EXPECT_EQ(error_of(""), "array.toml: array.rows: is missing; it has no default");
}

TEST(ArrayToml, refuses_a_misspelt_key_with_the_nearest_known) {
  EXPECT_EQ(error_of(with("load_ohm", "load_ohms")),
            "array.toml:12: unknown key 'readout.load_ohms'; did you mean 'readout.load_ohm'?");
  EXPECT_EQ(error_of(with("[readout]", "[readot]")), "array.toml:8: unknown table 'readot'; did you mean 'readout'?");
  EXPECT_EQ(error_of(with("rows = 2", "rowz = 2")),
            "array.toml:3: unknown key 'array.rowz'; did you mean 'array.rows'?");
}

TEST(ArrayToml, refuses_sizes_out_of_range) {
  EXPECT_EQ(error_of(with("rows = 2", "rows = 0")), "array.toml:3: array.rows: must be 1 to 1024");
  EXPECT_EQ(error_of(with("cols = 3", "cols = 1000000000000")), "array.toml:4: array.cols: must be 1 to 1024");
  EXPECT_EQ(error_of(with("cols = 3", "cols = -3")), "array.toml:4: array.cols: must be a whole number of 0 or more");
}

TEST(ArrayToml, refuses_lists_of_another_length) {
  EXPECT_EQ(error_of(with("[20.0, 21.0]", "[20.0]")),
            "array.toml:11: readout.drive_ohm: must be one number or a list of 2 numbers, has 1");
  EXPECT_EQ(error_of(with("[10.0, 12.5]", "10.0")), "array.toml:5: array.pitch_mm: must be a list of 2 numbers");
}

TEST(ArrayToml, refuses_fit_for_now) {
  EXPECT_EQ(error_of(with("= [20.0, 21.0]", "= \"fit\"")),
            "array.toml:11: readout.drive_ohm: \"fit\" is not available yet; give the resistance in ohm");
  EXPECT_EQ(error_of(with("= 200.0", "= \"fit\"")),
            "array.toml:12: readout.load_ohm: \"fit\" is not available yet; give the resistance in ohm");
}

TEST(ArrayToml, leaves_resistors_aside_where_the_circuit_is_unknown) {
  const Result<ArrayDescription> array = array_from_toml(with("\"divider\"", "\"none\""), "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_TRUE(array->readout.drive_ohm.empty());
  EXPECT_TRUE(array->readout.load_ohm.empty());
}

TEST(ArrayToml, refuses_unknown_choices) {
  EXPECT_EQ(error_of(with("\"divider\"", "\"bridge\"")),
            "array.toml:9: readout.circuit: must be \"divider\", \"transimpedance\" or \"none\"");
  EXPECT_EQ(error_of(with("\"floating\"", "1")),
            "array.toml:10: readout.idle_rows: must be \"grounded\" or \"floating\"");
}

TEST(ArrayToml, names_the_line_of_what_validate_refuses) {
  EXPECT_EQ(error_of(with("adc_bits = 12", "adc_bits = 25")), "array.toml:13: readout.adc_bits: must be 1 to 24");
  EXPECT_EQ(error_of(with("= 200.0", "= 0")), "array.toml:12: readout.load_ohm: must be more than 0 ohm");
}

TEST(ArrayToml, writes_what_reads_back_equal) {
  const TemporaryFolder folder;
  ArrayDescription array = array_from_toml(kComplete, "array.toml").value();
  array.name = "left \"arm\" \\ \n";
  array.readout.load_ohm = {1.0 / 3.0, 1e6, 47.0};
  ASSERT_TRUE(write_array(folder.file("a.toml"), array));
  const Result<ArrayDescription> read = read_array(folder.file("a.toml"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(array_to_toml(*read), array_to_toml(array));
  EXPECT_EQ(read->name, array.name);
  EXPECT_DOUBLE_EQ(read->col_pitch_m, array.col_pitch_m);
  EXPECT_DOUBLE_EQ(*read->taxel_area_m2, *array.taxel_area_m2);
  EXPECT_EQ(read->readout.drive_ohm, array.readout.drive_ohm);
  EXPECT_EQ(read->readout.load_ohm, array.readout.load_ohm);
}

TEST(ArrayToml, writes_no_invalid_array) {
  const TemporaryFolder folder;
  const Status written = write_array(folder.file("a.toml"), ArrayDescription{});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "array.rows: must be 1 to 1024");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(ArrayToml, gives_a_value_or_a_one_line_error_for_mutations) {
  expect_value_or_one_line_error(kComplete, 5000,
                                 [](const std::string& text) { return array_from_toml(text, "mutated"); });
}

}  // namespace
}  // namespace dermis::store
