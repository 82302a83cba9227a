// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/segment.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace dermis::learn::recognition {
namespace {

Layout two_fingers() {
  Layout layout;
  layout.arrays = {{"thumb", 13, 6, 0, 3.4, 3.4}, {"index", 13, 6, 78, 3.4, 3.4}};
  layout.readings = 156;
  return layout;
}

std::string error_of(const Layout& layout) {
  const Status status = layout.validate();
  return status ? "no error" : status.error().message;
}

TEST(SensedArray, of_an_array_has_its_shape_and_its_pitch_in_millimetres) {
  ArrayDescription array;
  array.name = "skin";
  array.rows = 3;
  array.cols = 5;
  array.row_pitch_m = 0.0035;
  array.col_pitch_m = 0.004;
  EXPECT_EQ(sensed_array(array, "left hand"), (SensedArray{"left hand", 3, 5, 0, 3.5, 4.0}));
}

TEST(Layout, of_two_arrays_is_good) {
  EXPECT_EQ(error_of(two_fingers()), "no error");
}

TEST(Layout, names_the_array_that_does_not_fit_into_the_frame) {
  Layout layout = two_fingers();
  layout.readings = 155;
  EXPECT_EQ(error_of(layout), "array 'index': ends beyond the 155 readings of a frame");
  layout.arrays[1].first_column = std::numeric_limits<std::size_t>::max();
  EXPECT_EQ(error_of(layout), "array 'index': ends beyond the 155 readings of a frame");
}

TEST(Layout, refuses_arrays_that_overlap) {
  Layout layout = two_fingers();
  layout.arrays.assign(3, layout.arrays[0]);
  EXPECT_EQ(error_of(layout),
            "arrays: overlap, they have 234 taxels and a frame 156 readings; each reading belongs to one array");
}

TEST(Layout, refuses_a_rate_that_cannot_be) {
  Layout layout = two_fingers();
  for (const double rate : {0.0, 1e-3, 1e6}) {
    layout.rate_hz = rate;
    EXPECT_EQ(error_of(layout), "no error") << rate;
  }
  for (const double rate : {-1.0, 1e-300, 9e-4, 1.1e6, std::numeric_limits<double>::quiet_NaN()}) {
    layout.rate_hz = rate;
    EXPECT_EQ(error_of(layout), "rate_hz: must be 0.001 to 1e6, or 0 where it is not known") << rate;
  }
}

TEST(Layout, says_from_which_reading_on_its_quantity_means_anything) {
  Layout layout;
  EXPECT_EQ(layout.least_reading(), 1.0);
  EXPECT_FALSE(layout.has_forces());
  layout.quantity = Quantity::pressure;
  EXPECT_EQ(layout.least_reading(), 1.0);
  EXPECT_FALSE(layout.has_forces());
  layout.quantity = Quantity::force;
  EXPECT_EQ(layout.least_reading(), kLeastNewtons);
  EXPECT_TRUE(layout.has_forces());
}

TEST(Layout, refuses_what_is_out_of_range) {
  Layout layout = two_fingers();
  layout.arrays[0].rows = 0;
  EXPECT_NE(error_of(layout).find("rows and cols must be 1 to 1024"), std::string::npos);
  layout = two_fingers();
  layout.arrays[0].row_pitch_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of(layout).find("pitch"), std::string::npos);
  layout = two_fingers();
  layout.arrays[0].col_pitch_mm = 0.0;
  EXPECT_NE(error_of(layout).find("or none"), std::string::npos);
  layout.arrays.clear();
  EXPECT_NE(error_of(layout).find("arrays"), std::string::npos);
}

TEST(NamesOf, arrays_are_in_their_order) {
  EXPECT_EQ(names_of({{.name = "palm"}, {.name = "thumb"}}), (std::vector<std::string>{"palm", "thumb"}));
  EXPECT_TRUE(names_of({}).empty());
}

}  // namespace
}  // namespace dermis::learn::recognition
