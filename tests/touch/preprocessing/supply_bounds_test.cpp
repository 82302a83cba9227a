// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/supply_bounds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <tuple>

namespace dermis::touch::preprocessing {
namespace {

Readout readout(std::optional<double> nominal_v) {
  Readout readout;
  readout.adc_reference_v = 3.3;
  readout.supply_v = nominal_v;
  return readout;
}

void expect_range(const SupplyRange& range, double least_v, double most_v) {
  EXPECT_NEAR(range.least_v, least_v, 1e-12);
  EXPECT_NEAR(range.most_v, most_v, 1e-12);
}

TEST(SupplyBounds, trust_what_was_calibrated_and_one_percent_more) {
  expect_range(SupplyBounds(readout(5.0), SupplyRange{4.0, 6.0}).trusted(), 3.96, 6.06);
}

TEST(SupplyBounds, of_a_calibration_at_one_supply_trust_nominal_within_the_usual_tolerance) {
  expect_range(SupplyBounds(readout(5.0), SupplyRange{5.0, 5.0}).trusted(), 0.99 * 4.5, 1.01 * 5.5);
}

TEST(SupplyBounds, trust_nominal_within_a_fifth_where_it_is_not_known_what_was_calibrated) {
  const SupplyBounds bounds(readout(5.0), std::nullopt);
  expect_range(bounds.trusted(), 4.0, 6.0);
  EXPECT_FALSE(bounds.is_plausible(6.1));
}

TEST(SupplyBounds, call_implausible_what_is_a_fifth_from_nominal_and_was_not_calibrated) {
  const SupplyBounds bounds(readout(5.0), SupplyRange{3.0, 5.0});
  EXPECT_TRUE(bounds.is_plausible(3.0));
  EXPECT_FALSE(bounds.is_plausible(2.9));
  EXPECT_TRUE(bounds.is_plausible(6.0));
  EXPECT_FALSE(bounds.is_plausible(6.1));
}

TEST(SupplyBounds, use_what_is_trusted_else_the_nearest_else_nominal_and_doubt_it) {
  const SupplyBounds bounds(readout(5.0), SupplyRange{4.5, 5.5});
  for (const auto& [supply_v, used_v, doubt] : {std::tuple(4.6, 4.6, 0.0), std::tuple(4.0, 4.455, 0.25),
                                                std::tuple(2.5, 5.0, 1.0), std::tuple(10.0, 5.0, 0.5)}) {
    EXPECT_NEAR(bounds.used(supply_v), used_v, 1e-12);
    EXPECT_NEAR(bounds.doubt(supply_v), doubt, 1e-12);
  }
}

TEST(SupplyBounds, take_the_middle_of_the_calibration_for_nominal_where_none_is_given) {
  const SupplyBounds bounds(readout(std::nullopt), SupplyRange{3.0, 3.6});
  expect_range(bounds.trusted(), 0.99 * 0.9 * 3.3, 1.01 * 1.1 * 3.3);
  EXPECT_TRUE(bounds.is_possible(1.2));
  EXPECT_FALSE(bounds.is_possible(1.0));
  EXPECT_TRUE(bounds.is_in_millivolts(3300.0));
}

TEST(SupplyBounds, know_millivolts_even_where_nothing_but_the_reference_is_known) {
  const SupplyBounds bounds(readout(std::nullopt), std::nullopt);
  EXPECT_TRUE(bounds.is_possible(1.1));
  EXPECT_TRUE(bounds.is_possible(24.0));
  EXPECT_TRUE(bounds.is_plausible(24.0));
  EXPECT_TRUE(bounds.is_in_millivolts(1100.0));
  EXPECT_TRUE(bounds.is_in_millivolts(24000.0));
  EXPECT_FALSE(bounds.is_possible(1e308));
  EXPECT_FALSE(bounds.is_in_millivolts(1e308));
}

TEST(SupplyBounds, bound_nothing_where_the_reference_is_the_supply) {
  Readout ratiometric = readout(5.0);
  ratiometric.adc_reference_v.reset();
  const SupplyBounds bounds(ratiometric, SupplyRange{4.5, 5.5});
  for (const double supply_v : {1e-300, 5000.0, 1e308}) {
    EXPECT_TRUE(bounds.trusted().contains(supply_v));
    EXPECT_TRUE(bounds.is_possible(supply_v));
    EXPECT_FALSE(bounds.is_in_millivolts(supply_v));
  }
}

TEST(SupplyRange, is_consistent_where_it_is_finite_and_in_order) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE((SupplyRange{4.5, 5.5}.is_consistent()));
  EXPECT_TRUE((SupplyRange{5.0, 5.0}.is_consistent()));
  EXPECT_FALSE((SupplyRange{5.5, 4.5}.is_consistent()));
  EXPECT_FALSE((SupplyRange{kNan, 5.0}.is_consistent()));
  EXPECT_FALSE((SupplyRange{4.5, kNan}.is_consistent()));
  EXPECT_FALSE(SupplyRange{}.is_consistent());
}

}  // namespace
}  // namespace dermis::touch::preprocessing
