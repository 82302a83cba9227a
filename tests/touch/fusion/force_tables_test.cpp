// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/force_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::touch::fusion {
namespace {

/// Two tables of three knots.
ForceTables two_tables() {
  return {{1, 4}, 3, {1.0F, 2.0F, 4.0F, 1.0F, 3.0F, 5.0F}, {10.0F, 30.0F, 40.0F, 1.0F, 2.0F, 8.0F}, {0.0F, 0.02F}};
}

double newtons(const ForceTables& tables, std::size_t table, float siemens, float offset = 0.0F) {
  return std::exp(static_cast<double>(tables.at(table, siemens, offset).log_newtons));
}

TEST(ForceTables, go_straight_from_zero_through_the_knots_and_on_along_a_power) {
  const ForceTables tables = two_tables();
  EXPECT_NEAR(newtons(tables, 0, 1e-6F), 1e-5, 1e-10);
  EXPECT_NEAR(newtons(tables, 0, 0.5F), 5.0, 1e-5);
  EXPECT_NEAR(newtons(tables, 0, 1.0F), 10.0, 1e-5);
  EXPECT_NEAR(newtons(tables, 0, 1.5F), 20.0, 1e-4);
  EXPECT_NEAR(newtons(tables, 0, 4.0F), 40.0, 1e-4);
  EXPECT_NEAR(newtons(tables, 0, 6.0F), 60.0, 1e-4);  // as from a fourth of the heaviest force to it
  EXPECT_NEAR(newtons(tables, 1, 4.0F), 5.0, 1e-5);
}

TEST(ForceTables, know_where_their_line_from_zero_ends) {
  EXPECT_EQ(two_tables().line_end_siemens(0), 1.0F);
  const ForceTables padded{{0}, 4, {0.1F, 0.2F, 0.3F, 0.5F}, {1.0F, 2.0F, 3.0F, 9.0F}, {0.0F}};
  EXPECT_EQ(padded.line_end_siemens(0), 0.3F);
}

TEST(ForceTables, turn_the_conductance_to_the_reference_temperature) {
  const ForceTables tables = two_tables();
  EXPECT_NEAR(newtons(tables, 1, 4.0F, 12.5F), newtons(tables, 1, 5.0F), 1e-4);
  EXPECT_GT(newtons(tables, 1, 4.0F, -1000.0F), 0.0);  // however cold
}

TEST(ForceTables, know_their_derivatives) {
  const ForceTables tables = two_tables();
  for (const float siemens : {0.3F, 1.7F, 3.5F, 9.0F}) {
    const float offset = 4.0F;
    const ForceTables::Value value = tables.at(1, siemens, offset);
    const double up = std::log(newtons(tables, 1, siemens * 1.01F, offset));
    const double down = std::log(newtons(tables, 1, siemens / 1.01F, offset));
    EXPECT_NEAR(value.exponent, (up - down) / (2.0 * std::log(1.01)), 2e-3);
    const double warmer = std::log(newtons(tables, 1, siemens, offset + 0.5F));
    const double colder = std::log(newtons(tables, 1, siemens, offset - 0.5F));
    EXPECT_NEAR(value.per_celsius, warmer - colder, 1e-3);
  }
}

TEST(ForceTables, noise_of_the_last_knots_does_not_bend_what_lies_beyond) {
  for (const float last_siemens : {4.001F, 4.12F, 4.3F}) {
    const ForceTables noisy = {{0}, 4, {1.0F, 2.0F, 4.0F, last_siemens}, {10.0F, 20.0F, 40.0F, 41.2F}, {0.0F}};
    EXPECT_NEAR(newtons(noisy, 0, 8.0F), 80.0, 8.0) << last_siemens;
    EXPECT_NEAR(noisy.at(0, 8.0F, 0.0F).exponent, 1.0F, 0.1F) << last_siemens;
    EXPECT_EQ(noisy.end_exponent(0), noisy.at(0, 8.0F, 0.0F).exponent);
  }
}

TEST(ForceTables, end_in_a_law_that_a_rubber_may_have) {
  const ForceTables steep = {{0}, 2, {4.0F, 4.001F}, {40.0F, 41.2F}, {0.0F}};
  EXPECT_EQ(steep.end_exponent(0), 3.0F);
  const ForceTables flat = {{0}, 2, {4.0F, 8.0F}, {40.0F, 40.1F}, {0.0F}};
  EXPECT_EQ(flat.end_exponent(0), 0.3F);
}

TEST(ForceTables, of_one_knot_are_lines_through_zero) {
  const ForceTables line = {{0}, 1, {2.0F}, {6.0F}, {0.0F}};
  EXPECT_TRUE(line.is_consistent(1));
  EXPECT_NEAR(newtons(line, 0, 5.0F), 15.0, 1e-4);
  EXPECT_EQ(line.at(0, 5.0F, 0.0F).exponent, 1.0F);
}

TEST(ForceTables, have_no_force_where_the_conductance_is_not_a_number) {
  EXPECT_TRUE(std::isnan(two_tables().at(0, std::numeric_limits<float>::quiet_NaN(), 0.0F).log_newtons));
}

TEST(ForceTables, are_consistent_only_where_they_rise_and_fit_the_array) {
  EXPECT_TRUE(ForceTables{}.is_consistent(3));
  EXPECT_TRUE(two_tables().is_consistent(5));
  EXPECT_FALSE(two_tables().is_consistent(4));
  const auto breaks = [](auto change) {
    ForceTables tables = two_tables();
    change(tables);
    return !tables.is_consistent(5);
  };
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.taxels = {4, 4}; }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.taxels = {1}; }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.knots = 0; }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.siemens[0] = 0.0F; }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.siemens[2] = 2.0F; }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.newtons[5] = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.newtons[4] = std::numeric_limits<float>::quiet_NaN(); }));
  EXPECT_TRUE(breaks([](ForceTables& tables) { tables.per_celsius.clear(); }));
}

}  // namespace
}  // namespace dermis::touch::fusion
