// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/conditioner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::preprocessing {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

ArrayDescription make_array(std::size_t rows = 1, std::size_t cols = 3) {
  return support::reference_circuit(rows, cols);
}

RawFrame make_frame(std::vector<float> counts, std::optional<double> supply_v = {}) {
  RawFrame frame;
  frame.counts = std::move(counts);
  frame.supply_v = supply_v;
  return frame;
}

ConditionedFrame condition(const ArrayDescription& array, const RawFrame& raw) {
  Conditioner conditioner(array);
  ConditionedFrame conditioned;
  conditioner.process(raw, conditioned);
  return conditioned;
}

Rejection rejection_of(const RawFrame& raw) {
  Conditioner conditioner(make_array());
  ConditionedFrame conditioned;
  conditioner.process(raw, conditioned);
  EXPECT_EQ(conditioner.rejection() != Rejection::none, conditioned.status == FrameStatus::rejected);
  return conditioner.rejection();
}

TEST(Conditioner, ratiometric_reading_does_not_know_the_supply) {
  for (const std::optional<double> supply_v : {std::optional<double>(), std::optional(3.0), std::optional(5.5)}) {
    const auto conditioned = condition(make_array(), make_frame({0.0F, 1023.75F, 4095.0F}, supply_v));
    EXPECT_EQ(conditioned.ratio, (std::vector<double>{0.0, 0.25, 1.0}));
  }
}

TEST(Conditioner, reference_in_volts_is_divided_by_the_measured_supply) {
  ArrayDescription array = make_array();
  array.readout.adc_reference_v = 3.3;
  array.readout.supply_v = 5.0;
  const auto conditioned = condition(array, make_frame({0.0F, 819.0F, 4095.0F}, 4.5));
  EXPECT_EQ(conditioned.ratio[0], 0.0);
  EXPECT_NEAR(conditioned.ratio[1], 0.2 * 3.3 / 4.5, 1e-15);
  EXPECT_NEAR(conditioned.ratio[2], 3.3 / 4.5, 1e-15);
}

TEST(Conditioner, reference_in_volts_is_divided_by_the_nominal_supply_of_a_frame_that_carries_none) {
  ArrayDescription array = make_array();
  array.readout.adc_reference_v = 3.3;
  array.readout.supply_v = 5.0;
  EXPECT_NEAR(condition(array, make_frame({0.0F, 819.0F, 4095.0F})).ratio[1], 0.2 * 3.3 / 5.0, 1e-15);
}

TEST(Conditioner, ratio_follows_the_resolution_of_the_adc) {
  for (int bits = 1; bits <= 24; ++bits) {
    ArrayDescription array = make_array();
    array.readout.adc_bits = bits;
    const auto full_scale = static_cast<double>((1L << bits) - 1);
    const auto conditioned = condition(array, make_frame({0.0F, 1.0F, static_cast<float>(full_scale)}));
    EXPECT_NEAR(conditioned.ratio[1] * full_scale, 1.0, 1e-12) << bits << " bit";
    EXPECT_NEAR(conditioned.ratio[2], 1.0, 1e-15) << bits << " bit";
    EXPECT_EQ(conditioned.taxels[2], TaxelStatus::saturated) << bits << " bit";
  }
}

TEST(Conditioner, formula_holds_for_random_supplies_references_and_fractional_counts) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    ArrayDescription array = make_array(4, 5);
    array.readout.adc_bits = 8 + static_cast<int>(random.below(17));
    array.readout.adc_reference_v = random.uniform(1.0, 6.0);
    array.readout.pressure_raises_reading = seed % 2 == 0;
    const double full_scale = array.readout.full_scale_counts();
    RawFrame raw = make_frame(std::vector<float>(20), random.uniform(2.0, 6.0));
    for (float& count : raw.counts) count = static_cast<float>(random.uniform(0.01, 0.99) * full_scale);
    const auto conditioned = condition(array, raw);
    for (std::size_t k = 0; k < 20; ++k) {
      const double volts = static_cast<double>(raw.counts[k]) / full_scale * *array.readout.adc_reference_v;
      const double share = volts / *raw.supply_v;
      EXPECT_NEAR(conditioned.ratio[k], seed % 2 == 0 ? share : 1.0 - share, 1e-14);
    }
    EXPECT_EQ(conditioned.status, FrameStatus::ok);
  }
}

TEST(Conditioner, ratio_rises_with_pressure_where_pressure_lowers_the_reading) {
  ArrayDescription array = make_array();
  array.readout.pressure_raises_reading = false;
  EXPECT_EQ(condition(array, make_frame({4095.0F, 1023.75F, 0.0F})).ratio, (std::vector<double>{0.0, 0.75, 1.0}));
}

TEST(Conditioner, saturation_is_the_end_of_the_adc_that_pressure_drives_to) {
  ArrayDescription array = make_array(1, 4);
  const RawFrame raw = make_frame({0.0F, 0.5F, 4094.5F, 4095.0F});
  const auto rising = condition(array, raw);
  EXPECT_EQ(rising.taxels, (std::vector{TaxelStatus::ok, TaxelStatus::ok, TaxelStatus::ok, TaxelStatus::saturated}));
  EXPECT_EQ(rising.status, FrameStatus::saturated);
  array.readout.pressure_raises_reading = false;
  const auto falling = condition(array, raw);
  EXPECT_EQ(falling.taxels, (std::vector{TaxelStatus::saturated, TaxelStatus::ok, TaxelStatus::ok, TaxelStatus::ok}));
  EXPECT_EQ(falling.status, FrameStatus::saturated);
}

TEST(Conditioner, a_frame_without_saturated_taxels_is_ok) {
  EXPECT_EQ(condition(make_array(), make_frame({0.0F, 1.0F, 4094.0F})).status, FrameStatus::ok);
}

TEST(Conditioner, time_and_temperature_go_through) {
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  raw.time = Nanos(-17);
  raw.temperature_celsius = -12.5;
  const auto conditioned = condition(make_array(), raw);
  EXPECT_EQ(conditioned.time, Nanos(-17));
  EXPECT_EQ(conditioned.temperature_celsius, -12.5);
  EXPECT_FALSE(condition(make_array(), make_frame({1.0F, 2.0F, 3.0F})).temperature_celsius);
}

TEST(Conditioner, accepts_the_ends_of_the_adc_range) {
  EXPECT_EQ(rejection_of(make_frame({0.0F, -0.0F, 4095.0F})), Rejection::none);
}

TEST(Conditioner, rejects_a_frame_of_another_shape) {
  for (const std::size_t size : {0U, 2U, 4U}) {
    EXPECT_EQ(rejection_of(make_frame(std::vector<float>(size))), Rejection::wrong_shape) << size << " readings";
  }
}

TEST(Conditioner, rejects_a_supply_that_is_not_a_number_and_an_infinite_temperature) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rejection_of(make_frame({1.0F, 2.0F, 3.0F}, kInfinite)), Rejection::not_a_number);
  EXPECT_EQ(rejection_of(make_frame({1.0F, 2.0F, 3.0F}, std::numeric_limits<double>::quiet_NaN())),
            Rejection::not_a_number);
  RawFrame hot = make_frame({1.0F, 2.0F, 3.0F});
  hot.temperature_celsius = -kInfinite;
  EXPECT_EQ(rejection_of(hot), Rejection::not_a_number);
}

TEST(Conditioner, a_temperature_of_nan_is_no_temperature) {
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  raw.temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  const auto conditioned = condition(make_array(), raw);
  EXPECT_EQ(conditioned.status, FrameStatus::ok);
  EXPECT_FALSE(conditioned.temperature_celsius);
}

TEST(Conditioner, a_taxel_without_a_reading_alone_is_invalid_and_reads_as_its_neighbours) {
  const ArrayDescription array = make_array(2, 3);
  for (const float bad : {kNan, kInfinity, -kInfinity, -0.001F, 4095.01F}) {
    const auto conditioned = condition(array, make_frame({bad, 819.0F, 4095.0F, 0.0F, 2457.0F, 0.0F}));
    EXPECT_EQ(conditioned.status, FrameStatus::saturated) << bad;
    EXPECT_EQ(conditioned.taxels, (std::vector{TaxelStatus::invalid, TaxelStatus::ok, TaxelStatus::saturated,
                                               TaxelStatus::ok, TaxelStatus::ok, TaxelStatus::ok}));
    EXPECT_NEAR(conditioned.ratio[0], (0.2 + 0.0 + 0.6) / 3.0, 1e-12) << bad;
    EXPECT_NEAR(conditioned.ratio[1], 0.2, 1e-12) << bad;
  }
}

TEST(Conditioner, a_reading_beyond_the_adc_is_not_saturated) {
  EXPECT_EQ(condition(make_array(), make_frame({1.0F, 5000.0F, 3.0F})).status, FrameStatus::ok);
}

TEST(Conditioner, rejects_a_frame_that_lacks_more_than_half_of_its_readings) {
  Conditioner conditioner(make_array(2, 2));
  ConditionedFrame conditioned;
  conditioner.process(make_frame({1.0F, kNan, 2.0F, -1.0F}), conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::none);
  conditioner.process(make_frame({kNan, kNan, 2.0F, -1.0F}), conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::too_few_readings);
  EXPECT_EQ(conditioned.status, FrameStatus::rejected);
}

TEST(Conditioner, a_taxel_that_the_sheet_does_not_have_reads_nothing_and_is_no_missing_reading) {
  ArrayDescription array = make_array(2, 2);
  array.absent = {0, 1, 2};
  for (const float reading : {kNan, 0.0F, 4095.0F, 9999.0F}) {
    const auto conditioned = condition(array, make_frame({reading, reading, reading, 819.0F}));
    EXPECT_EQ(conditioned.status, FrameStatus::ok) << reading;
    EXPECT_EQ(conditioned.taxels,
              (std::vector{TaxelStatus::invalid, TaxelStatus::invalid, TaxelStatus::invalid, TaxelStatus::ok}));
    EXPECT_EQ(std::vector<double>(conditioned.ratio.begin(), conditioned.ratio.begin() + 3), std::vector<double>(3));
    EXPECT_NEAR(conditioned.ratio[3], 0.2, 1e-12);
  }
}

TEST(Conditioner, readings_at_the_rail_are_saturated) {
  ArrayDescription array = make_array();
  array.readout.rail_counts = 4000.0;
  EXPECT_EQ(condition(array, make_frame({3999.0F, 4000.0F, 4095.0F})).taxels,
            (std::vector{TaxelStatus::ok, TaxelStatus::saturated, TaxelStatus::saturated}));
  array.readout.pressure_raises_reading = false;
  array.readout.rail_counts = 100.0;
  EXPECT_EQ(condition(array, make_frame({101.0F, 100.0F, 0.0F})).taxels,
            (std::vector{TaxelStatus::ok, TaxelStatus::saturated, TaxelStatus::saturated}));
}

TEST(Conditioner, rejects_a_supply_that_is_not_positive) {
  EXPECT_EQ(rejection_of(make_frame({1.0F, 2.0F, 3.0F}, 0.0)), Rejection::supply_not_positive);
  EXPECT_EQ(rejection_of(make_frame({1.0F, 2.0F, 3.0F}, -5.0)), Rejection::supply_not_positive);
}

/// A divider at 5 V whose ADC has a reference in volts.
ArrayDescription at_5_volts() {
  ArrayDescription array = make_array();
  array.readout.adc_reference_v = 3.3;
  array.readout.supply_v = 5.0;
  return array;
}

/// Of an array that was calibrated at 4.5 to 5.5 V.
ConditionedFrame condition_calibrated(const ArrayDescription& array, double supply_v) {
  Conditioner conditioner(array, SupplyRange{4.5, 5.5});
  ConditionedFrame conditioned;
  conditioner.process(make_frame({0.0F, 819.0F, 4095.0F}, supply_v), conditioned);
  return conditioned;
}

TEST(Conditioner, a_supply_of_the_calibration_is_divided_out_as_it_was_measured) {
  for (const double supply_v : {4.46, 4.5, 5.0, 5.5, 5.55}) {
    const auto conditioned = condition_calibrated(at_5_volts(), supply_v);
    EXPECT_EQ(conditioned.status, FrameStatus::saturated) << supply_v;
    EXPECT_EQ(conditioned.supply_doubt, 0.0) << supply_v;
    EXPECT_NEAR(conditioned.ratio[1], 0.2 * 3.3 / supply_v, 1e-15);
  }
}

TEST(Conditioner, a_supply_outside_of_the_calibration_is_replaced_and_doubted_by_its_distance_from_nominal) {
  for (const auto& [supply_v, used_v, flag] :
       {std::tuple(4.2, 4.455, FrameStatus::supply_clamped), std::tuple(5.9, 5.555, FrameStatus::supply_clamped),
        std::tuple(2.0, 5.0, FrameStatus::supply_implausible),
        std::tuple(10.0, 5.0, FrameStatus::supply_implausible)}) {
    const auto conditioned = condition_calibrated(at_5_volts(), supply_v);
    EXPECT_EQ(conditioned.status, FrameStatus::saturated | flag) << supply_v;
    EXPECT_NEAR(conditioned.ratio[1], 0.2 * 3.3 / used_v, 1e-15) << supply_v;
    EXPECT_NEAR(conditioned.supply_doubt, std::abs(5.0 / supply_v - 1.0), 1e-12) << supply_v;
  }
}

TEST(Conditioner, a_doubted_supply_is_told_beside_missing_readings) {
  Conditioner conditioner(at_5_volts(), SupplyRange{4.5, 5.5});
  ConditionedFrame conditioned;
  conditioner.process(make_frame({1.0F, kNan, 3.0F}, 4.2), conditioned);
  EXPECT_EQ(conditioned.status, FrameStatus::supply_clamped);
}

TEST(Conditioner, rejects_a_supply_that_the_readout_cannot_have_and_says_what_is_expected) {
  for (const double supply_v : {1e-300, 0.1, 1.6, 15.1, 1e308}) {
    EXPECT_EQ(condition_calibrated(at_5_volts(), supply_v).status, FrameStatus::rejected) << supply_v;
  }
  Conditioner conditioner(at_5_volts(), SupplyRange{4.5, 5.5});
  ConditionedFrame conditioned;
  conditioner.process(make_frame({1.0F, 2.0F, 3.0F}, 0.1), conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::supply_impossible);
  EXPECT_EQ(conditioner.why_rejected(), "a supply of 0.1 V (1.67 to 15 V are possible): check what measures it");
  conditioner.process(make_frame({1.0F, 2.0F, 3.0F}, 5000.0), conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::supply_in_millivolts);
  EXPECT_EQ(conditioner.why_rejected(),
            "a supply of 5000 V (1.67 to 15 V are possible): it looks like millivolts, give volts");
  conditioner.process(make_frame({1.0F, 2.0F, 3.0F}, 5.0), conditioned);
  EXPECT_EQ(conditioner.why_rejected(), "");
  EXPECT_EQ(conditioned.status, FrameStatus::ok);
}

TEST(Conditioner, of_a_calibration_takes_every_supply_that_is_possible) {
  for (const double supply_v : {1.7, 3.0, 14.9}) {
    const auto conditioned = condition(at_5_volts(), make_frame({0.0F, 819.0F, 4094.0F}, supply_v));
    EXPECT_EQ(conditioned.status, FrameStatus::ok) << supply_v;
    EXPECT_NEAR(conditioned.ratio[1], 0.2 * 3.3 / supply_v, 1e-15) << supply_v;
  }
  EXPECT_EQ(condition(at_5_volts(), make_frame({0.0F, 1.0F, 2.0F}, 5000.0)).status, FrameStatus::rejected);
}

TEST(Conditioner, any_supply_is_right_where_the_reading_does_not_depend_on_it) {
  for (const double supply_v : {0.1, 2.0, 5000.0, 1e308}) {
    const auto conditioned = condition_calibrated(make_array(), supply_v);
    EXPECT_EQ(conditioned.status, FrameStatus::saturated) << supply_v;
    EXPECT_EQ(conditioned.supply_doubt, 0.0) << supply_v;
  }
}

TEST(Conditioner, rejects_time_going_backwards_but_not_time_standing_still) {
  Conditioner conditioner(make_array());
  ConditionedFrame conditioned;
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  const auto rejection_at = [&](int nanoseconds) {
    raw.time = Nanos(nanoseconds);
    conditioner.process(raw, conditioned);
    return conditioner.rejection();
  };
  EXPECT_EQ(rejection_at(-5), Rejection::none);
  EXPECT_EQ(rejection_at(10), Rejection::none);
  EXPECT_EQ(rejection_at(10), Rejection::none);
  EXPECT_EQ(rejection_at(9), Rejection::time_going_backwards);
  EXPECT_EQ(rejection_at(10), Rejection::none);
  EXPECT_EQ(rejection_at(11), Rejection::none);
}

TEST(Conditioner, loses_one_frame_where_the_clock_jumps) {
  Conditioner conditioner(make_array());
  ConditionedFrame conditioned;
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  std::size_t rejected = 0;
  for (const int nanoseconds : {1, 2, 1'000'000, 3, 4, 5}) {  // one time far in the future
    raw.time = Nanos(nanoseconds);
    conditioner.process(raw, conditioned);
    if (conditioner.rejection() != Rejection::none) ++rejected;
  }
  EXPECT_EQ(rejected, 1U);
}

TEST(Conditioner, needs_a_supply_where_the_reference_is_in_volts) {
  ArrayDescription array = make_array();
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v.reset();
  ConditionedFrame conditioned;
  Conditioner conditioner(array);
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  raw.supply_v.reset();
  conditioner.process(raw, conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::supply_unknown);
  raw.supply_v = 5.0;
  conditioner.process(raw, conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::none);

  array.readout.circuit = Circuit::none;
  raw.supply_v.reset();
  Conditioner unknown_circuit(array);
  unknown_circuit.process(raw, conditioned);
  EXPECT_EQ(unknown_circuit.rejection(), Rejection::none);
}

TEST(Conditioner, pressures_and_forces_may_be_below_zero) {
  ArrayDescription array = make_array();
  array.readout = Readout();
  array.readout.circuit = Circuit::none;
  array.readout.quantity = Quantity::force;
  array.readout.adc_bits = 24;
  const ConditionedFrame forces = condition(array, make_frame({-0.5F, 2.0F, kNan}));
  EXPECT_EQ(forces.taxels[0], TaxelStatus::ok);
  EXPECT_EQ(forces.taxels[1], TaxelStatus::ok);
  EXPECT_EQ(forces.taxels[2], TaxelStatus::invalid);
  EXPECT_DOUBLE_EQ(forces.ratio[1] / forces.ratio[0], -4.0);
}

TEST(Conditioner, a_rejected_frame_leaves_the_clock_untouched) {
  Conditioner conditioner(make_array());
  ConditionedFrame conditioned;
  RawFrame raw = make_frame({1.0F, 2.0F, 3.0F});
  raw.time = Nanos(10);
  conditioner.process(raw, conditioned);
  RawFrame broken = make_frame({1.0F, kNan, kNan});
  broken.time = Nanos(1'000'000);
  conditioner.process(broken, conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::too_few_readings);
  raw.time = Nanos(5);
  conditioner.process(raw, conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::time_going_backwards);
  raw.time = Nanos(11);
  conditioner.process(raw, conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::none);
  EXPECT_EQ(conditioned.status, FrameStatus::ok);
}

TEST(Conditioner, a_rejected_frame_has_the_shape_of_the_array_and_only_invalid_taxels) {
  Conditioner conditioner(make_array(2, 3));
  ConditionedFrame conditioned;
  conditioner.process(make_frame(std::vector<float>(6, 4095.0F)), conditioned);
  EXPECT_EQ(conditioned.status, FrameStatus::saturated);
  RawFrame broken = make_frame({1.0F});
  broken.time = Nanos(3);
  broken.temperature_celsius = 25.0;
  conditioner.process(broken, conditioned);
  EXPECT_EQ(conditioned.status, FrameStatus::rejected);
  EXPECT_EQ(conditioned.time, Nanos(3));
  EXPECT_EQ(conditioned.ratio, std::vector<double>(6, 0.0));
  EXPECT_EQ(conditioned.taxels, std::vector<TaxelStatus>(6, TaxelStatus::invalid));
}

TEST(Conditioner, recovers_fully_after_a_rejected_frame) {
  Conditioner conditioner(make_array());
  ConditionedFrame conditioned;
  conditioner.process(make_frame({1.0F}), conditioned);
  conditioner.process(make_frame({1.0F, 2.0F, 4095.0F}), conditioned);
  EXPECT_EQ(conditioner.rejection(), Rejection::none);
  EXPECT_EQ(conditioned.status, FrameStatus::saturated);
  EXPECT_EQ(conditioned.taxels, (std::vector{TaxelStatus::ok, TaxelStatus::ok, TaxelStatus::saturated}));
}

TEST(Rejection, every_reason_has_words_of_its_own) {
  std::set<std::string> words;
  for (const Rejection reason :
       {Rejection::none, Rejection::wrong_shape, Rejection::not_a_number, Rejection::too_few_readings,
        Rejection::supply_not_positive, Rejection::supply_impossible, Rejection::supply_in_millivolts,
        Rejection::supply_unknown, Rejection::time_going_backwards}) {
    words.insert(to_string(reason));
  }
  EXPECT_EQ(words.size(), 9U);
}

TEST(Conditioner, several_sensors_give_each_taxel_a_temperature_and_the_frame_their_mean) {
  ArrayDescription array = make_array();
  array.temperature_sensors = sensors_on_each_taxel(array.rows, array.cols);
  RawFrame raw = make_frame({0.0F, 1.0F, 2.0F});
  raw.sensor_celsius = {20.0F, 21.0F, 25.0F};
  const ConditionedFrame conditioned = condition(array, raw);
  EXPECT_EQ(conditioned.taxel_celsius, raw.sensor_celsius);
  EXPECT_EQ(conditioned.temperature_celsius, 22.0);
}

TEST(Conditioner, without_readings_of_its_sensors_a_frame_has_its_one_temperature) {
  ArrayDescription array = make_array();
  array.temperature_sensors = {{0.0, 0.0}, {0.0, 2.0}};
  RawFrame raw = make_frame({0.0F, 1.0F, 2.0F});
  raw.temperature_celsius = 23.5;
  raw.sensor_celsius = {kNan, kNan};
  const ConditionedFrame conditioned = condition(array, raw);
  EXPECT_TRUE(conditioned.taxel_celsius.empty());
  EXPECT_EQ(conditioned.temperature_celsius, 23.5);
}

TEST(BareReadings, are_the_share_of_full_scale_whatever_the_supply) {
  ArrayDescription array = make_array();
  array.readout.adc_reference_v = 3.3;
  std::vector<double> reading(3);
  bare_readings(array, make_frame({0.0F, 1023.75F, 4095.0F}, 4.5), reading);
  EXPECT_EQ(reading, (std::vector<double>{0.0, 0.25, 1.0}));
}

TEST(BareReadings, are_zero_where_there_is_none) {
  std::vector<double> reading(3);
  bare_readings(make_array(), make_frame({kNan, 4096.0F, 4095.0F}), reading);
  EXPECT_EQ(reading, (std::vector<double>{0.0, 0.0, 1.0}));
}

TEST(BareReadings, rise_with_pressure_where_pressure_lowers_the_counts) {
  ArrayDescription array = make_array();
  array.readout.pressure_raises_reading = false;
  std::vector<double> reading(3);
  bare_readings(array, make_frame({0.0F, 1023.75F, 4095.0F}), reading);
  EXPECT_EQ(reading, (std::vector<double>{1.0, 0.75, 0.0}));
}

}  // namespace
}  // namespace dermis::touch::preprocessing
