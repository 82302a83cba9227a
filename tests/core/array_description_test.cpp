// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/array_description.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dermis {
namespace {

ArrayDescription valid_array() {
  ArrayDescription array;
  array.rows = 2;
  array.cols = 3;
  array.taxel_area_m2 = 1e-4;
  array.readout.drive_ohm = {0.0, 20.0};
  array.readout.load_ohm = {200.0, 200.0, 200.0};
  array.readout.adc_reference_v = 3.3;
  array.readout.supply_v = 5.0;
  return array;
}

/// What validate() says after one change to a valid array.
template <typename Change>
std::string message_after(const Change& change) {
  ArrayDescription array = valid_array();
  change(array);
  const Status status = array.validate();
  if (status) return "valid";
  EXPECT_EQ(status.error().kind, ErrorKind::bad_input);
  return status.error().message;
}

TEST(ArrayDescription, counts_taxels_row_by_row) {
  const ArrayDescription array = valid_array();
  EXPECT_EQ(array.taxel_count(), 6U);
  EXPECT_EQ(array.index(0, 2), 2U);
  EXPECT_EQ(array.index(1, 0), 3U);
}

TEST(ArrayDescription, is_valid_with_every_field_in_range) {
  EXPECT_EQ(message_after([](ArrayDescription&) {}), "valid");
}

TEST(ArrayDescription, needs_no_resistors_without_a_circuit) {
  EXPECT_EQ(message_after([](ArrayDescription& array) {
              array.readout.circuit = Circuit::none;
              array.readout.drive_ohm.clear();
              array.readout.load_ohm.clear();
            }),
            "valid");
}

TEST(ArrayDescription, names_the_field_out_of_range) {
  using Array = ArrayDescription;
  EXPECT_EQ(message_after([](Array& array) { array.rows = 0; }), "array.rows: must be 1 to 1024");
  EXPECT_EQ(message_after([](Array& array) { array.cols = 1025; }), "array.cols: must be 1 to 1024");
  EXPECT_EQ(message_after([](Array& array) { array.row_pitch_m = 0.0; }), "array.pitch_mm: must be more than 0 mm");
  EXPECT_EQ(message_after([](Array& array) { array.col_pitch_m = NAN; }), "array.pitch_mm: must be more than 0 mm");
  EXPECT_EQ(message_after([](Array& array) { array.taxel_area_m2 = -1.0; }),
            "array.taxel_area_mm2: must be more than 0 mm2");
  EXPECT_EQ(message_after([](Array& array) { array.readout.adc_bits = 25; }), "readout.adc_bits: must be 1 to 24");
  EXPECT_EQ(message_after([](Array& array) { array.readout.adc_reference_v = 0.0; }),
            "readout.adc_reference_v: must be more than 0 V");
  EXPECT_EQ(message_after([](Array& array) { array.readout.supply_v = INFINITY; }),
            "readout.supply_v: must be more than 0 V");
  EXPECT_EQ(message_after([](Array& array) {
              array.readout.drive_ohm = {-1.0, 1.0};
            }),
            "readout.drive_ohm: must be 0 or more ohm");
  EXPECT_EQ(message_after([](Array& array) { array.readout.load_ohm[2] = 0.0; }),
            "readout.load_ohm: must be more than 0 ohm");
  EXPECT_EQ(message_after([](Array& array) { array.readout.load_ohm.pop_back(); }),
            "readout.load_ohm: has 2 values, the array needs 3");
}

TEST(Readout, has_the_full_scale_of_its_adc) {
  Readout readout;
  EXPECT_EQ(readout.full_scale_counts(), 4095.0);
  readout.adc_bits = 24;
  EXPECT_EQ(readout.full_scale_counts(), 16777215.0);
}

TEST(ArrayDescription, has_names_as_in_files) {
  EXPECT_EQ(taxel_name(3, 15), "r3c15");
  EXPECT_STREQ(to_string(Circuit::divider), "divider");
  EXPECT_STREQ(to_string(Circuit::transimpedance), "transimpedance");
  EXPECT_STREQ(to_string(Circuit::none), "none");
  EXPECT_STREQ(to_string(IdleRows::grounded), "grounded");
  EXPECT_STREQ(to_string(IdleRows::floating), "floating");
}

TEST(ArrayDescription, names_a_taxel_by_its_row_major_index) {
  ArrayDescription array;
  array.rows = 3;
  array.cols = 4;
  EXPECT_EQ(array.taxel_name(array.index(2, 1)), "r2c1");
}

}  // namespace
}  // namespace dermis
