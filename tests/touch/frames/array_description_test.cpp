// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/array_description.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

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

TEST(ArrayDescription, doubts_lengths_in_metres_that_were_to_be_in_millimetres) {
  EXPECT_EQ(message_after([](ArrayDescription& array) { array.row_pitch_m = 15e-6; }),
            "array.pitch_mm: must be 0.05 to 1000; is 0.015 in metres? Then write 15");
  EXPECT_EQ(message_after([](ArrayDescription& array) { array.taxel_area_m2 = 38.48e-12; }),
            "array.taxel_area_mm2: must be 0.0025 to 1000000; is 3.848e-05 in metres? Then write 38.48");
  EXPECT_EQ(message_after([](ArrayDescription& array) { array.col_pitch_m = 15.0; }),
            "array.pitch_mm: must be 0.05 to 1000");
}

TEST(ArrayDescription, names_the_field_out_of_range) {
  using Array = ArrayDescription;
  EXPECT_EQ(message_after([](Array& array) { array.rows = 0; }), "array.rows: must be 1 to 1024");
  EXPECT_EQ(message_after([](Array& array) { array.cols = 1025; }), "array.cols: must be 1 to 1024");
  EXPECT_EQ(message_after([](Array& array) { array.row_pitch_m = 0.0; }), "array.pitch_mm: must be 0.05 to 1000");
  EXPECT_EQ(message_after([](Array& array) { array.col_pitch_m = NAN; }), "array.pitch_mm: must be 0.05 to 1000");
  EXPECT_EQ(message_after([](Array& array) { array.taxel_area_m2 = -1.0; }),
            "array.taxel_area_mm2: must be 0.0025 to 1000000");
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

TEST(ArrayDescription, names_what_is_wrong_with_its_absent_taxels_and_its_rail) {
  using Array = ArrayDescription;
  EXPECT_EQ(message_after([](Array& array) {
              array.absent = {1, 1};
            }),
            "array.absent: must name each taxel once, row by row");
  EXPECT_EQ(message_after([](Array& array) { array.absent = {array.taxel_count()}; }),
            "array.absent: must name taxels of the array");
  EXPECT_EQ(message_after([](Array& array) { array.absent = {0, 1, 2, 3, 4, 5}; }),
            "array.absent: must leave at least one taxel");
  EXPECT_EQ(message_after([](Array& array) { array.readout.rail_counts = 4096.0; }),
            "readout.rail_counts: must be a reading of the ADC, 0 to 2^adc_bits - 1");
}

TEST(ArrayDescription, readings_that_are_forces_have_nothing_of_an_adc) {
  const auto as = [](Quantity quantity) {
    return [quantity](ArrayDescription& array) {
      array.readout = Readout();
      array.readout.circuit = Circuit::none;
      array.readout.quantity = quantity;
    };
  };
  EXPECT_EQ(message_after(as(Quantity::pressure)), "valid");
  EXPECT_EQ(message_after(as(Quantity::force)), "valid");
  const auto pressure_with = [&](auto change) {
    return message_after([&](ArrayDescription& array) {
      as(Quantity::pressure)(array);
      change(array);
    });
  };
  EXPECT_EQ(pressure_with([](auto& array) { array.taxel_area_m2.reset(); }),
            "array.taxel_area_mm2: is needed where readings are pressures");
  EXPECT_EQ(pressure_with([](auto& array) { array.readout.circuit = Circuit::divider; }),
            "readout.circuit: readings that are forces have no circuit");
  EXPECT_EQ(pressure_with([](auto& array) { array.readout.adc_reference_v = 3.3; }),
            "readout.adc_reference_v: belongs to counts; leave it out");
  EXPECT_EQ(pressure_with([](auto& array) { array.readout.pressure_raises_reading = false; }),
            "readout.pressure_raises_reading: belongs to counts; leave it out");
}

TEST(ArrayDescription, knows_its_absent_taxels) {
  ArrayDescription array;
  array.absent = {2, 5};
  EXPECT_TRUE(array.is_absent(2) && array.is_absent(5));
  EXPECT_FALSE(array.is_absent(0) || array.is_absent(3) || array.is_absent(6));
}

TEST(ArrayDescription, counts_the_lines_that_are_driven_and_sensed) {
  ArrayDescription array = valid_array();
  EXPECT_EQ(array.driven_lines(), 2U);
  EXPECT_EQ(array.sensed_lines(), 3U);
  array.readout.circuit = Circuit::flexitac;
  EXPECT_EQ(array.driven_lines(), 3U);
  EXPECT_EQ(array.sensed_lines(), 2U);
  EXPECT_EQ(array.validate().error().message, "readout.drive_ohm: has 2 values, the array needs 3");
  std::swap(array.readout.drive_ohm, array.readout.load_ohm);
  array.readout.load_ohm = {100.0, 200.0};
  EXPECT_TRUE(array.validate());
}

TEST(ArrayDescription, knows_whether_a_reading_can_be_computed) {
  ArrayDescription array = valid_array();
  EXPECT_FALSE(array.has_unknown_circuit());
  array.readout.load_ohm[1] = kFitOhm;
  EXPECT_TRUE(array.validate());
  EXPECT_TRUE(array.has_unknown_circuit());
  array.readout.circuit = Circuit::none;
  EXPECT_FALSE(array.has_unknown_circuit());
  array.readout.circuit = Circuit::automatic;
  array.readout.drive_ohm = {20.0};
  array.readout.load_ohm.clear();
  EXPECT_TRUE(array.validate());
  EXPECT_TRUE(array.has_unknown_circuit());
}

TEST(ArrayDescription, names_the_part_of_the_circuit_out_of_range) {
  using Array = ArrayDescription;
  const auto amplified = [](Array& array) { array.readout.circuit = Circuit::transimpedance; };
  EXPECT_EQ(message_after([](Array& array) { array.readout.adc_noise_counts = 0.0; }),
            "readout.adc_noise_counts: must be more than 0");
  for (const double noise : {-0.001, 0.101, static_cast<double>(NAN)}) {
    EXPECT_EQ(message_after([&](Array& array) { array.readout.supply_noise = noise; }),
              "readout.supply_noise: must be 0 to 0.1");
  }
  EXPECT_EQ(message_after([&](Array& array) {
              amplified(array);
              array.readout.idle_columns = IdleColumns::floating;
            }),
            "readout.idle_columns: belongs to circuit = \"divider\"");
  EXPECT_EQ(message_after([](Array& array) { array.readout.amplifier_gain = 100.0; }),
            "readout.circuit: amplifier_offset_v and amplifier_gain belong to \"transimpedance\"");
  EXPECT_EQ(message_after([&](Array& array) {
              amplified(array);
              array.readout.amplifier_gain = INFINITY;
            }),
            "readout.amplifier_gain: must be 1 or more; leave it out for an ideal amplifier");
  EXPECT_EQ(message_after([&](Array& array) {
              amplified(array);
              array.readout.column_switch_ohm = {1.0, kFitOhm, 1.0};
            }),
            "readout.column_switch_ohm: must be 0 or more ohm");
  EXPECT_EQ(message_after([&](Array& array) {
              amplified(array);
              array.readout.amplifier_offset_v = {0.0, 0.0, NAN};
            }),
            "readout.amplifier_offset_v: must be less than the supply");
  EXPECT_EQ(message_after([&](Array& array) {
              amplified(array);
              array.readout.amplifier_offset_v = {0.0, 0.0, 0.0};
              array.readout.supply_v.reset();
            }),
            "readout.amplifier_offset_v: needs readout.supply_v, the nominal supply");
  EXPECT_EQ(message_after([](Array& array) { array.readout.row_segment_ohm = {1.0}; }),
            "readout.row_segment_ohm: has 1 values, the array needs 2");
  EXPECT_EQ(message_after([](Array& array) {
              array.readout.column_segment_ohm = {1.0, -1.0, 1.0};
            }),
            "readout.column_segment_ohm: must be 0 or more ohm");
}

TEST(ArrayDescription, an_unknown_circuit_has_one_value_for_all_lines) {
  using Array = ArrayDescription;
  EXPECT_EQ(message_after([](Array& array) { array.readout.circuit = Circuit::automatic; }),
            "readout.drive_ohm: has 2 values, the array needs 1");
  EXPECT_EQ(message_after([](Array& array) {
              array.readout.circuit = Circuit::automatic;
              array.readout.drive_ohm.clear();
              array.readout.load_ohm = {0.0};
            }),
            "readout.load_ohm: must be more than 0 ohm");
  EXPECT_EQ(message_after([](Array& array) {
              array.readout.circuit = Circuit::automatic;
              array.readout.row_segment_ohm = {1.0, 1.0};
            }),
            "readout.circuit: \"auto\" takes lines for ideal; leave out the segment resistances");
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
  EXPECT_STREQ(to_string(Circuit::flexitac), "flexitac");
  EXPECT_STREQ(to_string(Circuit::none), "none");
  EXPECT_STREQ(to_string(Circuit::automatic), "auto");
  EXPECT_STREQ(to_string(IdleRows::grounded), "grounded");
  EXPECT_STREQ(to_string(IdleRows::floating), "floating");
  EXPECT_STREQ(to_string(IdleColumns::loaded), "loaded");
  EXPECT_STREQ(to_string(IdleColumns::floating), "floating");
}

TEST(ArrayDescription, names_a_taxel_by_its_row_major_index) {
  ArrayDescription array;
  array.rows = 3;
  array.cols = 4;
  EXPECT_EQ(array.taxel_name(array.index(2, 1)), "r2c1");
}

}  // namespace
}  // namespace dermis
