// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/missing_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dermis::touch::preprocessing {
namespace {

ArrayDescription array_of(std::size_t rows, std::size_t cols) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  return array;
}

ConditionedFrame frame_without(const ArrayDescription& array, const std::vector<std::size_t>& taxels) {
  ConditionedFrame frame;
  frame.taxels.assign(array.taxel_count(), TaxelStatus::ok);
  for (const std::size_t taxel : taxels) frame.taxels[taxel] = TaxelStatus::invalid;
  return frame;
}

TEST(MissingReadings, name_the_worst_taxels_first) {
  const ArrayDescription array = array_of(2, 3);
  MissingReadings missing(array);
  EXPECT_FALSE(missing.any());
  missing.add({}, frame_without(array, {5}));
  missing.add({}, frame_without(array, {1, 5}));
  missing.add({}, frame_without(array, {}));
  EXPECT_TRUE(missing.any());
  EXPECT_EQ(missing.describe(), "no reading (not a number, or outside the ADC) of r1c2 in 2, r0c1 in 1 of 3 frames");
}

TEST(MissingReadings, count_those_that_are_not_named) {
  const ArrayDescription array = array_of(1, 7);
  MissingReadings missing(array);
  missing.add({}, frame_without(array, {0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(
      missing.describe(),
      "no reading (not a number, or outside the ADC) of r0c0 in 1, r0c1 in 1, r0c2 in 1, r0c3 in 1, r0c4 in 1 of 1 "
      "frames, and of 2 more taxels");
}

TEST(MissingReadings, know_nothing_of_rejected_frames_and_absent_taxels) {
  ArrayDescription array = array_of(1, 2);
  array.absent = {1};
  MissingReadings missing(array);
  missing.add({}, frame_without(array, {1}));
  ConditionedFrame rejected = frame_without(array, {0, 1});
  rejected.status = FrameStatus::rejected;
  missing.add({}, rejected);
  EXPECT_FALSE(missing.any());
}

RawFrame frame_of(const std::vector<float>& counts) {
  RawFrame frame;
  frame.counts = counts;
  return frame;
}

TEST(MissingReadings, know_the_range_of_readings_that_no_ADC_gives) {
  ArrayDescription array = array_of(1, 2);
  array.readout.adc_bits = 10;
  const ConditionedFrame whole = frame_without(array, {});
  MissingReadings missing(array);
  missing.add(frame_of({NAN, NAN}), frame_without(array, {0, 1}));
  EXPECT_FALSE(missing.describe_range());
  missing.add(frame_of({3.0F, 1023.0F}), whole);
  EXPECT_FALSE(missing.describe_range());
  missing.add(frame_of({102300.0F, 7.0F}), whole);
  EXPECT_EQ(missing.describe_range(), "readings of 3 to 102300, but the ADC gives 0 to 1023 (adc_bits = 10)");
  MissingReadings tared(array);
  tared.add(frame_of({-57.0F, 7.0F}), whole);
  EXPECT_EQ(tared.describe_range(), "readings of -57 to 7, but the ADC gives 0 to 1023 (adc_bits = 10)");
}

TEST(MissingReadings, know_no_range_of_absent_taxels_and_of_forces) {
  ArrayDescription array = array_of(1, 2);
  array.absent = {1};
  const ConditionedFrame whole = frame_without(array, {});
  MissingReadings missing(array);
  missing.add(frame_of({0.0F, 1e9F}), whole);
  EXPECT_FALSE(missing.describe_range());
  array.absent.clear();
  array.readout.quantity = Quantity::force;
  MissingReadings forces(array);
  forces.add(frame_of({-3.0F, 1e9F}), whole);
  EXPECT_FALSE(forces.describe_range());
}

}  // namespace
}  // namespace dermis::touch::preprocessing
