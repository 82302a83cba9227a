// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/circuit_inversion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "support/circuits.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::health {
namespace {

constexpr double kNoiseRatio = 1e-4;
constexpr std::uint64_t kSeed = 5;

std::vector<double> readings_of(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  simulation::ReadoutCircuit::create(array)->ratios(siemens, ratio);
  return ratio;
}

CircuitInversion inversion_of(const ArrayDescription& array) {
  Result<CircuitInversion> inversion = CircuitInversion::create(array, kNoiseRatio);
  EXPECT_TRUE(inversion);
  return *std::move(inversion);
}

void expect_inverted(const ArrayDescription& array, std::uint64_t seed) {
  Random random(seed);
  const std::vector<double> siemens = support::random_siemens(array, random);
  CircuitInversion inversion = inversion_of(array);
  ASSERT_TRUE(inversion.invert(readings_of(array, siemens)));
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    EXPECT_NEAR(inversion.siemens()[k], siemens[k], 1e-9 * siemens[k] + 1e-14) << "seed " << seed << ", taxel " << k;
    EXPECT_GT(inversion.sigma_siemens()[k], 0.0);
  }
}

TEST(CircuitInversion, finds_the_conductances_that_gave_the_readings) {
  expect_inverted(support::reference_circuit(4, 5), kSeed);
}

TEST(CircuitInversion, turns_readings_round_that_fall_with_pressure) {
  ArrayDescription array = support::reference_circuit(4, 5);
  array.readout.pressure_raises_reading = false;
  expect_inverted(array, kSeed + 1);
}

TEST(CircuitInversion, of_a_frame_does_not_depend_on_the_one_before) {
  const ArrayDescription array =
      support::reference_circuit(3, 3, Circuit::flexitac);  // whose inversion goes step by step
  Random random(kSeed);
  const std::vector<double> first = readings_of(array, support::random_siemens(array, random));
  const std::vector<double> second = readings_of(array, support::random_siemens(array, random));
  CircuitInversion fresh = inversion_of(array);
  CircuitInversion used = inversion_of(array);
  ASSERT_TRUE(used.invert(first));
  ASSERT_TRUE(used.invert(second));
  ASSERT_TRUE(fresh.invert(second));
  EXPECT_EQ(used.siemens(), fresh.siemens());
}

TEST(CircuitInversion, is_nan_where_no_conductances_give_the_readings) {
  const ArrayDescription array = support::reference_circuit(3, 3);
  CircuitInversion inversion = inversion_of(array);
  EXPECT_FALSE(inversion.invert(std::vector<double>(9, 1.5)));
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_TRUE(std::isnan(inversion.siemens()[k]));
    EXPECT_TRUE(std::isnan(inversion.sigma_siemens()[k]));
  }
}

}  // namespace
}  // namespace dermis::learn::health
