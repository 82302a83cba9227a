// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/requests/array_request.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::out::serve {
namespace {

const std::string kMat = R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10,"transpose":true,)"
                         R"("flip_rows":false,"flip_cols":true})";

std::string error_of(const std::string& from, const std::string& to) {
  std::string text = kMat;
  const auto array = array_request(text.replace(text.find(from), from.size(), to));
  return array ? "no error" : array.error().message;
}

TEST(ArrayRequest, is_an_array_whose_circuit_is_to_be_found) {
  const auto array = array_request(kMat);
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->name, "mat");
  EXPECT_EQ((FrameShape{array->rows, array->cols}), (FrameShape{3, 4}));
  EXPECT_DOUBLE_EQ(array->row_pitch_m, 0.008);
  EXPECT_EQ(array->readout.adc_bits, 10);
  EXPECT_EQ(array->readout.circuit, Circuit::automatic);
  EXPECT_EQ(array->order, (LineOrder{.transpose = true, .flip_cols = true}));
}

TEST(ArrayRequest, names_the_field_that_is_wrong) {
  EXPECT_EQ(error_of("\"mat\"", "\"../mat\""), "name: must be letters, digits, '_' and '-'");
  EXPECT_EQ(error_of("\"rows\":3", "\"rows\":0"), "rows: must be 1 to 1024");
  EXPECT_EQ(error_of("\"cols\":4", "\"cols\":1025"), "cols: must be 1 to 1024");
  EXPECT_EQ(error_of("\"cols\":4", "\"cols\":-4"), "cols: must be 1 to 1024");
  EXPECT_EQ(error_of("\"adc_bits\":10", "\"adc_bits\":99999999999"), "readout.adc_bits: must be 1 to 24");
  EXPECT_EQ(error_of("true", "1"), "transpose: must be true or false");
}

TEST(ArrayRequest, of_a_shape_alone) {
  EXPECT_EQ(*shape_request(R"({"rows":12,"cols":10})"), (FrameShape{12, 10}));
  EXPECT_EQ(shape_request(R"({"rows":12})").error().message, "cols: must be 1 to 1024");
}

}  // namespace
}  // namespace dermis::out::serve
