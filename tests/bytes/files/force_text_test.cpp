// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/force_text.hpp"

#include <gtest/gtest.h>

namespace dermis::bytes::files {
namespace {

TEST(ForceText, a_number_alone_is_newtons) {
  EXPECT_DOUBLE_EQ(*parse_force("1.96"), 1.96);
  EXPECT_DOUBLE_EQ(*parse_force(" 0 "), 0.0);
  EXPECT_DOUBLE_EQ(*parse_force("-2e-1"), -0.2);
}

TEST(ForceText, units_of_force_and_of_mass_are_newtons) {
  EXPECT_DOUBLE_EQ(*parse_force("2 N"), 2.0);
  EXPECT_DOUBLE_EQ(*parse_force("250mN"), 0.25);
  EXPECT_DOUBLE_EQ(*parse_force("1 kN"), 1000.0);
  EXPECT_DOUBLE_EQ(*parse_force("200 g"), 1.96133);
  EXPECT_DOUBLE_EQ(*parse_force("0.2kg"), 1.96133);
}

TEST(ForceText, a_pressure_has_its_own_units) {
  EXPECT_DOUBLE_EQ(*parse_pressure("20"), 20e3);
  EXPECT_DOUBLE_EQ(*parse_pressure("20 kPa"), 20e3);
  EXPECT_DOUBLE_EQ(*parse_pressure("500Pa"), 500.0);
  EXPECT_DOUBLE_EQ(*parse_pressure("0.1 MPa"), 1e5);
  EXPECT_EQ(parse_pressure("2 N").error().message,
            "'2 N' is no pressure; write kPa, or a unit as in 20 kPa, 500 Pa or 0.1 MPa");
  EXPECT_EQ(parse_force("20 kPa").error().message, "'20 kPa' is a pressure; write a force, as 2 N or 200 g");
}

TEST(ForceText, anything_else_is_named_with_the_mend) {
  for (const char* const text : {"", "g", "heavy", "200 gram", "2 lb", "1,5 N", "2 n"}) {
    const Result<double> force = parse_force(text);
    ASSERT_FALSE(force) << text;
    EXPECT_EQ(force.error().message,
              "'" + std::string(text) + "' is no force; write newtons, or a unit as in 2 N, 200 g or 0.2 kg");
  }
}

}  // namespace
}  // namespace dermis::bytes::files
