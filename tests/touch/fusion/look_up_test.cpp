// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/look_up.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace dermis::touch::fusion {
namespace {

/// Two taxels, three knots each; the second one drifts by 1 % per degree.
LookUpTables make_tables() {
  LookUpTables tables;
  tables.name = "test";
  tables.reference_celsius = 20.0;
  tables.knots = 3;
  tables.knot_signal = {0.1, 0.2, 0.6, 0.0, 0.5, 1.0};
  tables.knot_newtons = {0.0, 1.0, 5.0, 0.0, 10.0, 40.0};
  tables.temperature_coefficient = {0.0, 0.01};
  return tables;
}

std::vector<float> estimate(const std::vector<double>& signal, std::optional<double> temperature_celsius = {}) {
  std::vector<float> newtons(signal.size());
  make_tables().estimate(signal, temperature_celsius, newtons);
  return newtons;
}

TEST(LookUpTables, knots_are_met) {
  EXPECT_EQ(estimate({0.1, 0.0}), (std::vector<float>{0.0F, 0.0F}));
  EXPECT_EQ(estimate({0.2, 0.5}), (std::vector<float>{1.0F, 10.0F}));
  EXPECT_EQ(estimate({0.6, 1.0}), (std::vector<float>{5.0F, 40.0F}));
}

TEST(LookUpTables, lines_between_the_knots_are_straight) {
  const auto newtons = estimate({0.3, 0.75});
  EXPECT_FLOAT_EQ(newtons[0], 2.0F);
  EXPECT_FLOAT_EQ(newtons[1], 25.0F);
}

TEST(LookUpTables, ends_are_clamped) {
  EXPECT_EQ(estimate({-3.0, -0.001}), (std::vector<float>{0.0F, 0.0F}));
  EXPECT_EQ(estimate({0.61, 1e9}), (std::vector<float>{5.0F, 40.0F}));
}

TEST(LookUpTables, signal_is_corrected_by_its_temperature_coefficient) {
  // 0.5 at 30 C becomes 0.55 for the second taxel: 13 N.
  const auto newtons = estimate({0.3, 0.5}, 30.0);
  EXPECT_FLOAT_EQ(newtons[0], 2.0F);
  EXPECT_FLOAT_EQ(newtons[1], 13.0F);
  EXPECT_FLOAT_EQ(estimate({0.3, 0.5}, 10.0)[1], 9.0F);
}

TEST(LookUpTables, without_a_temperature_the_reference_is_taken) {
  EXPECT_EQ(estimate({0.3, 0.7}), estimate({0.3, 0.7}, 20.0));
}

TEST(LookUpTables, force_never_falls_with_the_signal) {
  float last = 0.0F;
  for (double signal = -0.1; signal <= 1.2; signal += 1e-3) {
    const float newtons = estimate({0.0, signal})[1];
    EXPECT_GE(newtons, last) << signal;
    last = newtons;
  }
  EXPECT_EQ(last, 40.0F);
}

TEST(LookUpTables, signal_that_is_not_a_number_gives_no_force) {
  const auto newtons = estimate({std::numeric_limits<double>::quiet_NaN(), 0.5});
  EXPECT_TRUE(std::isnan(newtons[0]));
  EXPECT_FLOAT_EQ(newtons[1], 10.0F);
}

TEST(LookUpTables, knots_of_the_same_signal_are_a_step) {
  LookUpTables tables = make_tables();
  tables.knot_signal = {0.1, 0.3, 0.3, 0.0, 0.0, 0.0};
  EXPECT_TRUE(tables.is_consistent());
  std::vector<float> newtons(2);
  for (const double signal : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    tables.estimate(std::vector<double>{signal, 0.0}, {}, newtons);
    EXPECT_FLOAT_EQ(newtons[0], signal < 0.15 ? 0.0F : (signal < 0.25 ? 0.5F : 5.0F)) << signal;
    EXPECT_EQ(newtons[1], 0.0F);
  }
}

TEST(LookUpTables, sizes_and_numbers_are_checked) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(make_tables().is_consistent());
  const auto broken = [](auto damage) {
    LookUpTables tables = make_tables();
    damage(tables);
    return !tables.is_consistent();
  };
  EXPECT_TRUE(broken([](auto& t) { t.knots = 1; }));
  EXPECT_TRUE(broken([](auto& t) { t.knots = 2; }));
  EXPECT_TRUE(broken([](auto& t) { t.knot_signal.pop_back(); }));
  EXPECT_TRUE(broken([](auto& t) { t.knot_newtons.push_back(50.0); }));
  EXPECT_TRUE(broken([](auto& t) { t.temperature_coefficient.pop_back(); }));
  EXPECT_TRUE(broken([](auto& t) { t.reference_celsius = kNan; }));
  EXPECT_TRUE(broken([](auto& t) { t.knot_signal[2] = kInfinity; }));
  EXPECT_TRUE(broken([](auto& t) { t.knot_newtons[2] = kNan; }));
  EXPECT_TRUE(broken([](auto& t) { t.temperature_coefficient[0] = kNan; }));
  EXPECT_TRUE(broken([](auto& t) { t.knot_signal[4] = -1.0; }));   // falls along the knots
  EXPECT_TRUE(broken([](auto& t) { t.knot_newtons[4] = -1.0; }));  // the same
}

}  // namespace
}  // namespace dermis::touch::fusion
