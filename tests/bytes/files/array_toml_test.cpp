// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/array_toml.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
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

/// kFitOhm is not a number and so not equal to itself.
void expect_equal_or_fit(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])));
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
            "array.toml:11: readout.drive_ohm: must be a number or \"fit\", or a list of 2 of these, has 1");
  EXPECT_EQ(error_of(with("[10.0, 12.5]", "10.0")), "array.toml:5: array.pitch_mm: must be a list of 2 numbers");
}

TEST(ArrayToml, takes_fit_for_a_resistance_that_calibration_is_to_find) {
  const Result<ArrayDescription> whole = array_from_toml(with("= 200.0", "= \"fit\""), "array.toml");
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_TRUE(whole->has_unknown_circuit());
  ASSERT_EQ(whole->readout.load_ohm.size(), 3U);
  for (const double ohm : whole->readout.load_ohm) EXPECT_TRUE(std::isnan(ohm));
  const Result<ArrayDescription> one = array_from_toml(with("[20.0, 21.0]", "[20.0, \"fit\"]"), "array.toml");
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->readout.drive_ohm[0], 20.0);
  EXPECT_TRUE(std::isnan(one->readout.drive_ohm[1]));
  EXPECT_EQ(error_of(with("= 200.0", "= \"fitted\"")),
            "array.toml:12: readout.load_ohm: must be a number or \"fit\", or a list of 3 of these");
  EXPECT_EQ(error_of(with("= 200.0", "= nan")),
            "array.toml:12: readout.load_ohm: must be a number or \"fit\", or a list of 3 of these");
}

TEST(ArrayToml, takes_in_what_an_instrument_is_not_ideal_and_writes_it_again) {
  const std::string keys =
      "supply_ohm = 4.5\nadc_settling = 0.03\nadc_offset_counts = -2.5\nadc_curve = [[0, 0.15], [4000, 3.3]]\n";
  const Result<ArrayDescription> array =
      array_from_toml(with("adc_bits = 12\n", "adc_bits = 12\n" + keys), "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.supply_ohm, 4.5);
  EXPECT_EQ(array->readout.adc_errors.settling, 0.03);
  EXPECT_EQ(array->readout.adc_errors.offset_counts, -2.5);
  ASSERT_EQ(array->readout.adc_errors.curve.size(), 2U);
  EXPECT_EQ(array->readout.adc_errors.curve[1].sent_counts, 4000.0);
  EXPECT_NEAR(array->readout.adc_errors.curve[0].ideal_counts, 0.15 / 3.3 * 4095.0, 1e-9);
  EXPECT_FALSE(array->has_unknown_circuit());
  const Result<ArrayDescription> again = array_from_toml(array_to_toml(*array), "again.toml");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(array_to_toml(*again), array_to_toml(*array));
  EXPECT_EQ(again->readout.adc_errors.settling, 0.03);
}

TEST(ArrayToml, an_instrument_that_calibration_is_to_find_is_unknown) {
  for (const char* const key : {"supply_ohm", "adc_settling", "adc_offset_counts"}) {
    const std::string line = std::string(key) + " = \"fit\"\n";
    const Result<ArrayDescription> array =
        array_from_toml(with("adc_bits = 12\n", "adc_bits = 12\n" + line), "array.toml");
    ASSERT_TRUE(array) << array.error().message;
    EXPECT_TRUE(array->has_unknown_circuit()) << key;
    EXPECT_NE(array_to_toml(*array).find(line), std::string::npos) << key;
  }
}

TEST(ArrayToml, refuses_an_instrument_that_cannot_be) {
  const auto error_with = [](const std::string& line) {
    return error_of(with("adc_bits = 12\n", "adc_bits = 12\n" + line));
  };
  EXPECT_EQ(
      error_with("adc_settling = 0.7\n"),
      "array.toml:14: readout.adc_settling: must be 0 to 0.5, the share that a reading keeps of the one before it");
  EXPECT_EQ(error_with("adc_offset_counts = 5000\n"),
            "array.toml:14: readout.adc_offset_counts: must be less than 2^adc_bits - 1");
  EXPECT_EQ(error_with("supply_ohm = -1\n"), "array.toml:14: readout.supply_ohm: must be 0 or more ohm");
  EXPECT_EQ(error_with("adc_curve = [[0, 0]]\n"), "array.toml:14: readout.adc_curve: needs at least two points");
  EXPECT_EQ(error_with("adc_curve = [[0, 0], [10, 1], [10, 2]]\n"),
            "array.toml:14: readout.adc_curve: both columns must rise from point to point; point 2 does not");
  EXPECT_EQ(
      error_with("column_switch_ohm = 100\n"),
      "array.toml:14: readout.column_switch_ohm: carries no current where each column has its load; leave it out, "
      "or set idle_columns = \"floating\"");
}

TEST(ArrayToml, takes_one_resistance_for_all_lines_of_a_circuit_that_calibration_is_to_find) {
  constexpr const char* kAuto = "[array]\nrows = 2\ncols = 3\n[readout]\ncircuit = \"auto\"\nadc_bits = 12\n";
  const Result<ArrayDescription> array = array_from_toml(std::string(kAuto) + "load_ohm = 200\n", "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.circuit, Circuit::automatic);
  EXPECT_TRUE(array->has_unknown_circuit());
  EXPECT_TRUE(array->readout.drive_ohm.empty());
  EXPECT_EQ(array->readout.load_ohm, (std::vector<double>{200.0}));
  EXPECT_EQ(error_of(std::string(kAuto) + "load_ohm = [1, 2, 3]\n"),
            "array.toml:7: readout.load_ohm: must be a number or \"fit\", or a list of 1 of these, has 3");
}

constexpr const char* kAmplifiers = R"([array]
rows = 2
cols = 3

[readout]
circuit = "transimpedance"
drive_ohm = 0
load_ohm = [100, "fit", 300]
column_switch_ohm = [1, 2, 3]
amplifier_offset_v = [0.001, -0.002, 0]
amplifier_gain = 1e5
row_segment_ohm = 0.5
column_segment_ohm = [0, 1, 2]
adc_bits = 16
adc_noise_counts = 2.5
supply_noise = 0.002
supply_v = 5.0
)";

constexpr const char* kFlexitac = R"([array]
rows = 2
cols = 3
[readout]
circuit = "flexitac"
drive_ohm = [20, 21, 22]
drive_error_ohm = [1, 0, 2]
load_ohm = [1000, 2000]
column_segment_ohm = 5
adc_bits = 8
)";

TEST(ArrayToml, reads_the_parts_of_real_amplifiers_and_lines) {
  const Result<ArrayDescription> array = array_from_toml(kAmplifiers, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  const Readout& readout = array->readout;
  EXPECT_EQ(readout.column_switch_ohm, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(readout.amplifier_offset_v, (std::vector<double>{0.001, -0.002, 0.0}));
  EXPECT_EQ(readout.amplifier_gain, 1e5);
  EXPECT_EQ(readout.row_segment_ohm, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(readout.column_segment_ohm, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(readout.adc_noise_counts, 2.5);
  EXPECT_EQ(readout.supply_noise, 0.002);
}

TEST(ArrayToml, flexitac_drives_columns_and_reads_rows) {
  const Result<ArrayDescription> array = array_from_toml(kFlexitac, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.circuit, Circuit::flexitac);
  EXPECT_EQ(array->readout.drive_ohm, (std::vector<double>{20.0, 21.0, 22.0}));
  EXPECT_EQ(array->readout.load_ohm, (std::vector<double>{1000.0, 2000.0}));
}

TEST(ArrayToml, reads_what_idle_columns_end_in) {
  const Result<ArrayDescription> array = array_from_toml(std::string(kComplete) + "idle_columns = \"floating\"\n", "a");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.idle_columns, IdleColumns::floating);
}

TEST(ArrayToml, input_pullup_is_a_divider_upside_down_whose_rows_float) {
  const std::string pulled_up =
      "[array]\nrows = 2\ncols = 3\n[readout]\ncircuit = \"input_pullup\"\ndrive_ohm = 25\nload_ohm = 35e3\nadc_bits = "
      "10\n";
  const Result<ArrayDescription> array = array_from_toml(pulled_up, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.circuit, Circuit::divider);
  EXPECT_EQ(array->readout.idle_rows, IdleRows::floating);
  EXPECT_FALSE(array->readout.pressure_raises_reading);
  EXPECT_EQ(array->readout.load_ohm, std::vector<double>(3, 35e3));
  EXPECT_EQ(array_to_toml(*array), array_to_toml(*array_from_toml(array_to_toml(*array), "again")));

  const Result<ArrayDescription> high = array_from_toml(pulled_up + "idle_rows = \"grounded\"\n", "a");
  ASSERT_TRUE(high) << high.error().message;
  EXPECT_EQ(high->readout.idle_rows, IdleRows::grounded);

  EXPECT_EQ(error_of(pulled_up + "pressure_raises_reading = true\n"),
            "array.toml:9: readout.pressure_raises_reading: is false with circuit = \"input_pullup\"");
  EXPECT_TRUE(array_from_toml(pulled_up + "pressure_raises_reading = false\n", "a"));
}

TEST(ArrayToml, refuses_a_key_of_another_circuit) {
  EXPECT_EQ(error_of(std::string(kFlexitac) + "idle_rows = \"grounded\"\n"),
            "array.toml:11: readout.idle_rows: has no meaning with circuit = \"flexitac\", only with \"divider\" or "
            "\"transimpedance\"; remove it");
  EXPECT_EQ(error_of(std::string(kAmplifiers) + "idle_columns = \"loaded\"\n"),
            "array.toml:18: readout.idle_columns: has no meaning with circuit = \"transimpedance\", only with "
            "\"divider\"; remove it");
  EXPECT_EQ(error_of(std::string(kComplete) + "amplifier_gain = 1e5\n"),
            "array.toml:17: readout.amplifier_gain: has no meaning with circuit = \"divider\", only with "
            "\"transimpedance\"; remove it");
  EXPECT_EQ(error_of("[array]\nrows = 1\ncols = 1\n[readout]\ncircuit = \"auto\"\nadc_bits = 8\nrow_segment_ohm = 1\n"),
            "array.toml:7: readout.row_segment_ohm: has no meaning with circuit = \"auto\", only with \"divider\" or "
            "\"transimpedance\" or \"flexitac\"; remove it");
}

TEST(ArrayToml, refuses_parts_out_of_range) {
  const auto amplifiers_with = [](const std::string& from, const std::string& to) {
    std::string text = kAmplifiers;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(error_of(amplifiers_with("amplifier_gain = 1e5", "amplifier_gain = 0.5")),
            "array.toml:11: readout.amplifier_gain: must be 1 or more; leave it out for an ideal amplifier");
  EXPECT_EQ(error_of(amplifiers_with("supply_v = 5.0\n", "")),
            "array.toml:10: readout.amplifier_offset_v: needs readout.supply_v, the nominal supply");
  EXPECT_EQ(error_of(amplifiers_with("[0.001, -0.002, 0]", "[0.001, -6, 0]")),
            "array.toml:10: readout.amplifier_offset_v: must be less than the supply");
  EXPECT_EQ(error_of(amplifiers_with("[1, 2, 3]", "[1, -2, 3]")),
            "array.toml:9: readout.column_switch_ohm: must be 0 or more ohm");
  EXPECT_EQ(error_of(amplifiers_with("= 2.5", "= 0")), "array.toml:15: readout.adc_noise_counts: must be more than 0");
  EXPECT_EQ(error_of(amplifiers_with("row_segment_ohm = 0.5", "row_segment_ohm = \"fit\"")),
            "array.toml:12: readout.row_segment_ohm: must be one number or a list of 2 numbers");
}

constexpr const char* kTurned = R"([array]
rows = 2
cols = 3
skip_columns = 1
transpose = true
flip_rows = true
flip_cols = true
row_order = [1, 0]
col_order = [2, 0, 1]
[readout]
circuit = "none"
adc_bits = 8
)";

TEST(ArrayToml, reads_and_writes_which_way_round_the_lines_are_sent) {
  const Result<ArrayDescription> array = array_from_toml(kTurned, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->order, (LineOrder{1, true, true, true, {1, 0}, {2, 0, 1}}));
  EXPECT_EQ(array_from_toml(array_to_toml(*array), "again")->order, array->order);
  EXPECT_TRUE(array_from_toml(kComplete, "array.toml")->order.is_plain());
}

constexpr const char* kPicked = R"([array]
rows = 1
cols = 3
taxel_order = [7, 0, 4]
sent = [2, 4]
[readout]
circuit = "none"
adc_bits = 8
)";

TEST(ArrayToml, reads_and_writes_an_order_of_single_taxels) {
  const Result<ArrayDescription> array = array_from_toml(kPicked, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->order, (LineOrder{.taxel_order = {7, 0, 4}, .taxel_rows = 1, .taxels_sent = {2, 4}}));
  EXPECT_EQ(array_from_toml(array_to_toml(*array), "again")->order, array->order);
}

TEST(ArrayToml, refuses_an_order_of_taxels_that_cannot_be) {
  const auto picked_with = [](const std::string& from, const std::string& to) {
    std::string text = kPicked;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(error_of(picked_with("7, 0, 4", "8, 0, 4")),
            "array.toml:4: array.taxel_order: reading 8 is not among 8, counted from 0");
  EXPECT_EQ(error_of(picked_with("7, 0, 4", "7, 7, 4")), "array.toml:4: array.taxel_order: names reading 7 twice");
  EXPECT_EQ(error_of(picked_with("[2, 4]", "[2]")),
            "array.toml:5: array.sent: must be rows and columns of 1 to 1024, as [4, 8]");
  EXPECT_EQ(error_of(picked_with("taxel_order = [7, 0, 4]\n", "")),
            "array.toml:4: array.sent: has no meaning without taxel_order");
  EXPECT_NE(error_of(picked_with("7, 0, 4", "7, 0")), "");
}

TEST(ArrayToml, refuses_an_order_of_lines_that_cannot_be) {
  const auto turned_with = [](const std::string& from, const std::string& to) {
    std::string text = kTurned;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(error_of(turned_with("[1, 0]", "[1, 1]")),
            "array.toml:8: array.row_order: must name each line from 0 to 1 once");
  EXPECT_EQ(error_of(turned_with("[1, 0]", "[1, 0, 2]")), "array.toml:8: array.row_order: has 3 lines, the array 2");
  EXPECT_EQ(error_of(turned_with("[2, 0, 1]", "[2, 0, -1]")),
            "array.toml:9: array.col_order: must be a list of whole numbers of 0 or more");
  EXPECT_EQ(error_of(turned_with("skip_columns = 1", "skip_columns = 1024")),
            "array.toml:4: array.skip_columns: must be 0 to 1023");
}

TEST(ArrayToml, leaves_resistors_aside_where_the_circuit_is_unknown) {
  const Result<ArrayDescription> array = array_from_toml(with("\"divider\"", "\"none\""), "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_TRUE(array->readout.drive_ohm.empty());
  EXPECT_TRUE(array->readout.load_ohm.empty());
}

TEST(ArrayToml, refuses_unknown_choices) {
  EXPECT_EQ(error_of(with("\"divider\"", "\"bridge\"")),
            "array.toml:9: readout.circuit: must be \"divider\", \"transimpedance\", \"flexitac\", \"none\", \"auto\", "
            "\"pressure\", \"force\" or \"input_pullup\"");
  EXPECT_EQ(error_of(with("\"floating\"", "1")),
            "array.toml:10: readout.idle_rows: must be \"grounded\" or \"floating\"");
}

TEST(ArrayToml, names_the_line_of_what_validate_refuses) {
  EXPECT_EQ(error_of(with("adc_bits = 12", "adc_bits = 25")), "array.toml:13: readout.adc_bits: must be 1 to 24");
  EXPECT_EQ(error_of(with("= 200.0", "= 0")), "array.toml:12: readout.load_ohm: must be more than 0 ohm");
}

TEST(ArrayToml, writes_what_reads_back_equal) {
  const support::TemporaryFolder folder;
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

TEST(ArrayToml, reads_which_taxels_the_sheet_does_not_have) {
  const std::string text = with("[readout]", "absent = [\"r1c2\", \"r0c0:r0c1\", \"r0c0\"]\n[readout]");
  const Result<ArrayDescription> array = array_from_toml(text, "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->absent, (std::vector<std::size_t>{0, 1, 5}));
  EXPECT_EQ(array_from_toml(array_to_toml(*array), "array.toml").value().absent, array->absent);
  EXPECT_NE(error_of(with("[readout]", "absent = [\"r2c0\"]\n[readout]")).find("r2c0 does not exist in a 2x3 array"),
            std::string::npos);
  EXPECT_NE(error_of(with("[readout]", "absent = [\"all\"]\n[readout]")).find("must leave at least one taxel"),
            std::string::npos);
}

TEST(ArrayToml, reads_and_writes_a_cover) {
  const auto read_with = [](const std::string& lines) {
    return array_from_toml(with("[readout]", lines + "\n[readout]"), "array.toml");
  };
  const Result<ArrayDescription> spread = read_with("cover_spread_mm = 5");
  ASSERT_TRUE(spread) << spread.error().message;
  EXPECT_DOUBLE_EQ(spread->cover->spread_m, 0.005);
  EXPECT_NE(array_to_toml(*spread).find("cover_spread_mm = 5\n"), std::string::npos);
  const Result<ArrayDescription> shares = read_with("cover_shares = [[0, 0, 0.6], [0, 1, 0.1], [1, 0, 0.1]]");
  ASSERT_TRUE(shares) << shares.error().message;
  EXPECT_EQ(array_from_toml(array_to_toml(*shares), "array.toml")->cover->shares, shares->cover->shares);
  EXPECT_TRUE(read_with("cover = \"fit\"")->cover->is_unknown());
  EXPECT_NE(error_of(with("[readout]", "cover = \"foam\"\n[readout]")).find("must be \"fit\""), std::string::npos);
  EXPECT_NE(error_of(with("[readout]", "cover_spread_mm = -1\n[readout]")).find("must be 0 to 1000"),
            std::string::npos);
}

TEST(ArrayToml, reads_and_writes_where_the_temperature_is_measured) {
  const std::string key = "temperature_gradient_celsius = 4.5\ntemperature_sensors = ";
  const Result<ArrayDescription> few = array_from_toml(with("[readout]", key + "[[0, 0], [1, 1.5]]\n[readout]"), "a");
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_EQ(few->temperature_sensors, (std::vector<TemperatureSensor>{{0.0, 0.0}, {1.0, 1.5}}));
  EXPECT_EQ(few->temperature_gradient_celsius, 4.5);
  const Result<ArrayDescription> all = array_from_toml(with("[readout]", key + "\"each taxel\"\n[readout]"), "a");
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(all->temperature_sensors, sensors_on_each_taxel(2, 3));
  for (const ArrayDescription& array : {*few, *all}) {
    const ArrayDescription again = array_from_toml(array_to_toml(array), "a").value();
    EXPECT_EQ(again.temperature_sensors, array.temperature_sensors);
    EXPECT_EQ(again.temperature_gradient_celsius, 4.5);
  }
  EXPECT_NE(error_of(with("[readout]", "temperature_sensors = [[2, 0]]\n[readout]")).find("places [row, col] on the"),
            std::string::npos);
  EXPECT_NE(error_of(with("[readout]", "temperature_gradient_celsius = -1\n[readout]")).find("must be 0 to 100 C"),
            std::string::npos);
}

TEST(ArrayToml, reads_where_the_readout_saturates) {
  const Result<ArrayDescription> array = array_from_toml(std::string(kComplete) + "rail_counts = 4000\n", "array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.rail_counts, 4000.0);
  EXPECT_EQ(array_from_toml(array_to_toml(*array), "array.toml").value().readout.rail_counts, 4000.0);
}

TEST(ArrayToml, writes_every_circuit_without_loss) {
  constexpr const char* kAuto = "[array]\nrows = 2\ncols = 3\n[readout]\ncircuit = \"auto\"\nadc_bits = 12\n";
  for (const std::string& text :
       {std::string(kAmplifiers), std::string(kFlexitac), std::string(kComplete) + "idle_columns = \"floating\"\n",
        std::string(kAuto) + "drive_ohm = \"fit\"\nload_ohm = 200\n"}) {
    const ArrayDescription array = array_from_toml(text, "array.toml").value();
    const std::string written = array_to_toml(array);
    const Result<ArrayDescription> read = array_from_toml(written, "array.toml");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(array_to_toml(*read), written);
    EXPECT_EQ(read->readout.circuit, array.readout.circuit);
    EXPECT_EQ(read->readout.idle_rows, array.readout.idle_rows);
    EXPECT_EQ(read->readout.idle_columns, array.readout.idle_columns);
    expect_equal_or_fit(read->readout.drive_ohm, array.readout.drive_ohm);
    expect_equal_or_fit(read->readout.load_ohm, array.readout.load_ohm);
    EXPECT_EQ(read->readout.column_switch_ohm, array.readout.column_switch_ohm);
    EXPECT_EQ(read->readout.amplifier_offset_v, array.readout.amplifier_offset_v);
    EXPECT_EQ(read->readout.amplifier_gain, array.readout.amplifier_gain);
    EXPECT_EQ(read->readout.row_segment_ohm, array.readout.row_segment_ohm);
    EXPECT_EQ(read->readout.column_segment_ohm, array.readout.column_segment_ohm);
    EXPECT_EQ(read->readout.adc_noise_counts, array.readout.adc_noise_counts);
    EXPECT_EQ(read->readout.supply_noise, array.readout.supply_noise);
    EXPECT_EQ(read->readout.drive_error_ohm, array.readout.drive_error_ohm);
  }
}

TEST(ArrayToml, writes_no_invalid_array) {
  const support::TemporaryFolder folder;
  const Status written = write_array(folder.file("a.toml"), ArrayDescription{});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "array.rows: must be 1 to 1024");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(ArrayToml, gives_a_value_or_a_one_line_error_for_mutations) {
  for (const char* const text : {kComplete, kAmplifiers, kFlexitac}) {
    support::expect_value_or_one_line_error(
        text, 3000, [](const std::string& mutated) { return array_from_toml(mutated, "mutated"); });
  }
}

TEST(ArrayToml, readings_may_be_pressures_or_forces) {
  const std::string geometry = "[array]\nrows = 2\ncols = 3\ntaxel_area_mm2 = 100\n[readout]\n";
  for (const auto& [name, quantity] :
       {std::pair("pressure", Quantity::pressure), std::pair("force", Quantity::force)}) {
    const std::string circuit = std::string("circuit = \"") + name + "\"\n";
    const Result<ArrayDescription> array =
        array_from_toml(geometry + circuit + "adc_noise_counts = 0.5\n", "array.toml");
    ASSERT_TRUE(array) << array.error().message;
    EXPECT_EQ(array->readout.circuit, Circuit::none);
    EXPECT_EQ(array->readout.quantity, quantity);
    EXPECT_EQ(array->readout.adc_bits, 24);
    const Result<ArrayDescription> again = array_from_toml(array_to_toml(*array), "array.toml");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->readout.quantity, quantity);
    EXPECT_EQ(array_to_toml(*again), array_to_toml(*array));
    EXPECT_NE(error_of(geometry + circuit).find("readout.adc_noise_counts"), std::string::npos) << "it has no default";
  }
}

}  // namespace
}  // namespace dermis::bytes::files
