// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/adc_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/allocation_guard.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::preprocessing {
namespace {

ArrayDescription array_of(std::size_t rows, std::size_t cols) {
  return support::reference_circuit(rows, cols, Circuit::divider);
}

std::vector<float> corrected(const ArrayDescription& array, const std::vector<float>& counts) {
  AdcCorrection correction(array);
  const std::span<const float> ideal = correction.correct(counts);
  return {ideal.begin(), ideal.end()};
}

TEST(AdcCorrection, takes_the_share_of_the_reading_before_away) {
  ArrayDescription array = array_of(1, 4);
  array.readout.adc_errors.settling = 0.1;
  // x = 1000, 0, 500, 0 with v = 0.9 x + 0.1 v before it, the first at rest
  const std::vector<float> ideal = corrected(array, {1000.0F, 100.0F, 460.0F, 46.0F});
  EXPECT_FLOAT_EQ(ideal[0], 1000.0F);
  EXPECT_NEAR(ideal[1], 0.0F, 1e-4);
  EXPECT_FLOAT_EQ(ideal[2], 500.0F);
  EXPECT_NEAR(ideal[3], 0.0F, 1e-4);
}

TEST(AdcCorrection, the_first_reading_follows_the_last_of_the_frame_before_until_it_is_forgotten) {
  ArrayDescription array = array_of(1, 2);
  array.readout.adc_errors.settling = 0.1;
  AdcCorrection correction(array);
  (void)correction.correct(std::vector<float>{0.0F, 900.0F});
  EXPECT_NEAR(correction.correct(std::vector<float>{90.0F, 9.0F})[0], 0.0F, 1e-4);
  correction.forget();
  EXPECT_EQ(correction.correct(std::vector<float>{90.0F, 9.0F})[0], 90.0F);
}

TEST(AdcCorrection, follows_the_order_in_which_the_device_sends) {
  ArrayDescription array = array_of(2, 2);
  array.readout.adc_errors.settling = 0.1;
  array.order.transpose = true;
  const std::vector<float> ideal = corrected(array, {1000.0F, 10.0F, 100.0F, 1.0F});
  for (const std::size_t taxel : {1U, 2U, 3U}) EXPECT_NEAR(ideal[taxel], 0.0F, 1e-4) << taxel;
}

TEST(AdcCorrection, a_reading_at_the_rail_stays_and_does_not_spoil_the_next) {
  ArrayDescription array = array_of(1, 3);
  array.readout.adc_errors.settling = 0.1;
  const std::vector<float> ideal = corrected(array, {0.0F, 4095.0F, 409.5F});
  EXPECT_EQ(ideal[1], 4095.0F);
  EXPECT_NEAR(ideal[2], 0.0F, 1e-3);
}

TEST(AdcCorrection, behind_a_missing_reading_nothing_is_taken_away) {
  ArrayDescription array = array_of(1, 3);
  array.readout.adc_errors.settling = 0.1;
  const std::vector<float> ideal = corrected(array, {0.0F, std::numeric_limits<float>::quiet_NaN(), 500.0F});
  EXPECT_TRUE(std::isnan(ideal[1]));
  EXPECT_EQ(ideal[2], 500.0F);
}

TEST(AdcCorrection, offset_then_curve) {
  ArrayDescription array = array_of(1, 4);
  array.readout.adc_errors.offset_counts = 10.0;
  array.readout.adc_errors.curve = {{0.0, 100.0}, {1000.0, 1100.0}, {3000.0, 2100.0}};
  EXPECT_EQ(corrected(array, {10.0F, 510.0F, 2010.0F, 3110.0F}),
            (std::vector<float>{100.0F, 600.0F, 1600.0F, 2200.0F}));
  std::vector<float> slopes;
  AdcCorrection(array).find_slopes(std::vector<float>{10.0F, 510.0F, 2010.0F, 3110.0F}, slopes);
  EXPECT_EQ(slopes, (std::vector<float>{1.0F, 1.0F, 0.5F, 1.0F}));
}

TEST(AdcCorrection, noise_grows_by_what_is_taken_away) {
  AdcErrors errors;
  EXPECT_EQ(noise_gain(errors), 1.0);
  errors.settling = 0.2;
  EXPECT_NEAR(noise_gain(errors), std::sqrt(1.04) / 0.8, 1e-12);
}

TEST(AdcCorrection, allocates_nothing_in_a_frame) {
  ArrayDescription array = array_of(4, 4);
  array.readout.adc_errors.settling = 0.1;
  array.readout.adc_errors.curve = {{0.0, 0.0}, {4095.0, 4000.0}};
  AdcCorrection correction(array);
  const std::vector<float> counts(16, 700.0F);
  std::vector<float> slopes(16);
  const support::AllocationGuard guard;
  (void)correction.correct(counts);
  correction.find_slopes(counts, slopes);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::touch::preprocessing
