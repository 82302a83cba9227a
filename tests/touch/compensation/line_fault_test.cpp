// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/line_fault.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::touch::compensation {
namespace {

ArrayDescription array_of_4_rows_and_6_columns(Circuit circuit = Circuit::divider) {
  ArrayDescription array;
  array.rows = 4;
  array.cols = 6;
  array.readout.circuit = circuit;
  return array;
}

LineFault fault_at(LineFaultKind kind, std::size_t place) {
  LineFault fault;
  fault.kind = kind;
  fault.place = place;
  return fault;
}

TEST(LineFault, every_kind_has_its_name_place_and_masked_taxels) {
  struct Case {
    LineFaultKind kind;
    std::size_t place;
    const char* name;
    const char* place_name;
    std::size_t masked_taxels;
  };
  const Case cases[] = {
      {LineFaultKind::silent_row, 3, "silent_row", "row 3", 6},
      {LineFaultKind::silent_column, 5, "silent_column", "column 5", 4},
      {LineFaultKind::supplied_row, 0, "supplied_row", "row 0", 6},
      {LineFaultKind::supplied_column, 1, "supplied_column", "column 1", 4},
      {LineFaultKind::shorted_rows, 2, "shorted_rows", "rows 2 and 3", 12},
      {LineFaultKind::shorted_columns, 4, "shorted_columns", "columns 4 and 5", 8},
      {LineFaultKind::stuck_taxel, 7, "stuck_taxel", "taxel r1c1", 1},
      {LineFaultKind::dead_taxel, 23, "dead_taxel", "taxel r3c5", 1},
      {LineFaultKind::drifting_driver, 2, "drifting_driver", "driver of row 2", 0},
  };
  const ArrayDescription array = array_of_4_rows_and_6_columns();
  for (const Case& expected : cases) {
    const LineFault fault = fault_at(expected.kind, expected.place);
    EXPECT_STREQ(to_string(expected.kind), expected.name);
    EXPECT_EQ(place_name(fault, array), expected.place_name);
    EXPECT_EQ(masked_taxel_count(fault, array), expected.masked_taxels) << expected.name;
  }
}

TEST(LineFault, flexitac_drives_columns) {
  const ArrayDescription array = array_of_4_rows_and_6_columns(Circuit::flexitac);
  EXPECT_EQ(place_name(fault_at(LineFaultKind::drifting_driver, 5), array), "driver of column 5");
}

TEST(LineFault, faults_of_lines_have_an_axis_and_others_have_none) {
  for (int number = 0; number <= static_cast<int>(LineFaultKind::drifting_driver); ++number) {
    const LineFaultTraits& traits = traits_of(static_cast<LineFaultKind>(number));
    const bool is_of_lines = traits.scope == LineFaultScope::line || traits.scope == LineFaultScope::line_pair;
    EXPECT_EQ(traits.axis.has_value(), is_of_lines) << traits.name;
    if (!traits.axis) continue;
    EXPECT_NE(std::string(traits.name).find(to_string(*traits.axis)), std::string::npos) << traits.name;
  }
}

TEST(LineFault, conductances_are_hidden_where_nothing_but_a_rail_or_a_constant_is_read) {
  EXPECT_TRUE(traits_of(LineFaultKind::silent_row).hides_conductance);
  EXPECT_TRUE(traits_of(LineFaultKind::silent_column).hides_conductance);
  EXPECT_TRUE(traits_of(LineFaultKind::supplied_column).hides_conductance);
  EXPECT_TRUE(traits_of(LineFaultKind::stuck_taxel).hides_conductance);
  EXPECT_FALSE(traits_of(LineFaultKind::supplied_row).hides_conductance);
  EXPECT_FALSE(traits_of(LineFaultKind::shorted_rows).hides_conductance);
  EXPECT_FALSE(traits_of(LineFaultKind::shorted_columns).hides_conductance);
  EXPECT_FALSE(traits_of(LineFaultKind::dead_taxel).hides_conductance);
  EXPECT_FALSE(traits_of(LineFaultKind::drifting_driver).hides_conductance);
}

}  // namespace
}  // namespace dermis::touch::compensation
