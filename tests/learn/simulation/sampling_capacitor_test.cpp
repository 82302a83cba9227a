// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/sampling_capacitor.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/reference_array.hpp"

namespace dermis::learn::simulation {
namespace {

ArrayDescription array_with(double settling) {
  ArrayDescription array = support::reference_circuit(2, 2, Circuit::divider);
  array.readout.adc_errors.settling = settling;
  return array;
}

std::vector<double> sampled(SamplingCapacitor& capacitor, std::vector<double> ratio, double supply_v = 5.0) {
  capacitor.sample(ratio, supply_v);
  return ratio;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], expected[k], 1e-15) << "reading " << k;
}

TEST(SamplingCapacitor, a_reading_keeps_its_share_of_the_voltage_before_it) {
  SamplingCapacitor capacitor(array_with(0.1));
  expect_near(sampled(capacitor, {1.0, 0.0, 0.0, 0.0}), {1.0, 0.1, 0.01, 0.001});
}

TEST(SamplingCapacitor, the_first_reading_of_a_frame_follows_the_last_of_the_frame_before) {
  SamplingCapacitor capacitor(array_with(0.1));
  expect_near(sampled(capacitor, {0.0, 0.0, 0.0, 1.0}), {0.0, 0.0, 0.0, 0.9});
  expect_near(sampled(capacitor, {0.0, 0.0, 0.0, 0.0}), {0.09, 0.009, 0.0009, 0.00009});
}

TEST(SamplingCapacitor, it_holds_volts_whatever_the_supply_becomes) {
  SamplingCapacitor capacitor(array_with(0.1));
  sampled(capacitor, {0.0, 0.0, 0.0, 1.0}, 4.0);
  expect_near(sampled(capacitor, {0.0, 0.0, 0.0, 0.0}, 2.0), {0.18, 0.018, 0.0018, 0.00018});
}

TEST(SamplingCapacitor, the_scan_goes_as_the_device_sends) {
  ArrayDescription array = array_with(0.1);
  array.order.transpose = true;
  SamplingCapacitor capacitor(array);
  expect_near(sampled(capacitor, {1.0, 0.0, 0.0, 0.0}), {1.0, 0.01, 0.1, 0.001});
}

TEST(SamplingCapacitor, one_that_settles_changes_nothing) {
  SamplingCapacitor capacitor(support::reference_circuit(2, 2, Circuit::divider));
  EXPECT_EQ(sampled(capacitor, {0.3, 0.1, 0.7, 0.2}), (std::vector<double>{0.3, 0.1, 0.7, 0.2}));
}

}  // namespace
}  // namespace dermis::learn::simulation
