// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/axis.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dermis {
namespace {

ArrayDescription array_of_3_rows_and_5_columns() {
  ArrayDescription array;
  array.rows = 3;
  array.cols = 5;
  return array;
}

TEST(Axis, rows_cross_columns) {
  EXPECT_EQ(crossing(Axis::row), Axis::column);
  EXPECT_EQ(crossing(Axis::column), Axis::row);
  EXPECT_STREQ(to_string(Axis::row), "row");
  EXPECT_STREQ(to_string(Axis::column), "column");
}

TEST(Axis, a_value_per_axis_begins_at_zero_and_is_found_by_its_axis) {
  PerAxis<int> values;
  EXPECT_EQ(values, (PerAxis<int>{0, 0}));
  values[Axis::column] = 7;
  EXPECT_EQ(values.column, 7);
  EXPECT_EQ(values.row, 0);
  const PerAxis<const char*> names{.row = "down", .column = "across"};
  EXPECT_STREQ(names[Axis::row], "down");
  EXPECT_STREQ(names[Axis::column], "across");
}

TEST(Axis, the_lines_of_each_axis_visit_every_taxel_once) {
  const ArrayDescription array = array_of_3_rows_and_5_columns();
  EXPECT_EQ(line_count(array, Axis::row), 3U);
  EXPECT_EQ(line_length(array, Axis::row), 5U);
  EXPECT_EQ(line_count(array, Axis::column), 5U);
  EXPECT_EQ(line_length(array, Axis::column), 3U);
  for (const Axis axis : kAxes) {
    std::vector<int> visits(array.taxel_count());
    for (std::size_t line = 0; line < line_count(array, axis); ++line) {
      for (std::size_t place = 0; place < line_length(array, axis); ++place) {
        ++visits[taxel_on_line(array, axis, line, place)];
      }
    }
    EXPECT_EQ(visits, std::vector<int>(array.taxel_count(), 1)) << to_string(axis);
  }
  EXPECT_EQ(taxel_on_line(array, Axis::row, 1, 4), array.index(1, 4));
  EXPECT_EQ(taxel_on_line(array, Axis::column, 4, 1), array.index(1, 4));
}

TEST(Axis, rows_are_driven_but_by_flexitac) {
  ArrayDescription array = array_of_3_rows_and_5_columns();
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::flexitac, Circuit::none}) {
    array.readout.circuit = circuit;
    EXPECT_EQ(driven_axis(array), circuit == Circuit::flexitac ? Axis::column : Axis::row) << to_string(circuit);
    EXPECT_EQ(line_count(array, driven_axis(array)), array.driven_lines()) << to_string(circuit);
    EXPECT_EQ(line_length(array, driven_axis(array)), array.sensed_lines()) << to_string(circuit);
  }
}

}  // namespace
}  // namespace dermis
