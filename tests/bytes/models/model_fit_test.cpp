// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/models/model_fit.hpp"

#include <gtest/gtest.h>

namespace dermis::bytes::models {
namespace {

TEST(ModelFit, a_model_fits_an_array_of_the_same_size_pitch_and_readings) {
  ArrayDescription array;
  array.rows = 2;
  array.cols = 3;
  EXPECT_EQ(misfit(array, array), "");
  ArrayDescription larger = array;
  larger.rows = 3;
  EXPECT_EQ(misfit(array, larger), "it is of 3x3 taxels, the array of 2x3");
  ArrayDescription wider = array;
  wider.col_pitch_m = 2.0 * array.col_pitch_m + 0.001;
  EXPECT_EQ(misfit(array, wider), "it is of another pitch");
  ArrayDescription finer = array;
  finer.readout.adc_bits = array.readout.adc_bits + 2;
  EXPECT_EQ(misfit(array, finer), "it is of other readings: quantity, bits or direction differ");
}

TEST(ModelFit, circuits_are_not_compared) {
  ArrayDescription array;
  ArrayDescription other = array;
  array.readout.circuit = Circuit::divider;
  other.readout.circuit = Circuit::transimpedance;
  EXPECT_EQ(misfit(array, other), "");
}

}  // namespace
}  // namespace dermis::bytes::models
