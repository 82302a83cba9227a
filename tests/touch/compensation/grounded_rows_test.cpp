// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The circuits that are inverted by the fixed point of src/touch/compensation/grounded_rows.hpp, through the interface
// of dermis/touch/compensation/crosstalk.hpp. CircuitModel, which shares nothing with it, says what they read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/dense_solve.hpp"
#include "support/simd_targets.hpp"

namespace dermis::touch::compensation {
namespace {

using support::NamedCircuit;
using support::random_array;
using support::random_siemens;

std::vector<double> ratios_of(const ArrayDescription& array, const std::vector<double>& siemens) {
  auto model = CircuitModel::create(array);
  EXPECT_TRUE(model);
  model->solve(siemens);
  return {model->ratio().begin(), model->ratio().end()};
}

std::unique_ptr<CrosstalkInversion> inversion_for(const ArrayDescription& array,
                                                  std::optional<double> tolerance = 0.0) {
  auto inversion = make_crosstalk_inversion(array, {tolerance});
  EXPECT_TRUE(inversion) << inversion.error().message;
  return inversion ? std::move(*inversion) : nullptr;
}

/// Most that a reading differs from the circuit's; where a taxel is held at 0 S it may lie below.
double misfit(const ArrayDescription& array, const std::vector<double>& ratio, const std::vector<double>& siemens) {
  const auto model = ratios_of(array, siemens);
  double worst = 0.0;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    if (siemens[k] == 0.0 && ratio[k] < model[k]) continue;
    worst = std::max(worst, std::abs(ratio[k] - model[k]));
  }
  return worst;
}

std::size_t size_between(std::size_t least, std::size_t most, Random& random) {
  return least + random.below(most - least + 1);
}

class FixedPoint : public testing::TestWithParam<NamedCircuit> {};

std::vector<NamedCircuit> fixed_point_circuits() {
  auto circuits = support::all_circuits();
  std::erase_if(circuits, [](const NamedCircuit& circuit) {
    return circuit.resistive_lines || circuit.idle_rows == IdleRows::floating;
  });
  return circuits;
}

INSTANTIATE_TEST_SUITE_P(CrosstalkInversion, FixedPoint, testing::ValuesIn(fixed_point_circuits()),
                         [](const auto& info) { return info.param.name; });

TEST_P(FixedPoint, every_taxel_of_a_hundred_random_arrays_comes_back) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::size_t rows = size_between(2, 16, random);
    const auto array = random_array(GetParam(), rows, size_between(2, 16, random), random);
    const auto siemens = random_siemens(array, random);
    std::vector<double> inverted(siemens.size());
    const auto result = inversion_for(array)->invert(ratios_of(array, siemens), inverted);
    ASSERT_TRUE(result.solved);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-8) << array.taxel_name(k);
    }
  }
}

TEST_P(FixedPoint, large_arrays_come_back) {
  for (const std::size_t size : {32U, 64U}) {
    SCOPED_TRACE(testing::Message() << "size " << size);
    Random random(size);
    auto array = random_array(GetParam(), size, size - 3, random);
    for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(1.0, 50.0);
    const auto siemens = random_siemens(array, random, 1e3);
    std::vector<double> inverted(siemens.size());
    ASSERT_TRUE(inversion_for(array)->invert(ratios_of(array, siemens), inverted).solved);
    for (std::size_t k = 0; k < siemens.size(); ++k) ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-8) << k;
  }
}

TEST_P(FixedPoint, certificate_is_never_below_the_true_misfit) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::size_t rows = size_between(1, 12, random);
    const auto array = random_array(GetParam(), rows, size_between(1, 12, random), random);
    const double tolerance = random.log_uniform(1e-7, 1e-1);
    const double noise = seed % 2 == 0 ? 0.0 : random.log_uniform(1e-5, 1e-2);
    const auto inversion = inversion_for(array, tolerance);
    std::vector<double> inverted(array.taxel_count());
    for (int frame = 0; frame < 3; ++frame) {
      auto ratio = ratios_of(array, random_siemens(array, random));
      for (double& reading : ratio) reading += noise * random.normal();
      const auto result = inversion->invert(ratio, inverted);
      if (!result.solved) continue;
      ASSERT_LE(result.residual_ratio, tolerance);
      ASSERT_LE(misfit(array, ratio, inverted), result.residual_ratio + 1e-13);
    }
  }
}

TEST_P(FixedPoint, a_reading_below_what_the_neighbours_cause_gives_zero_and_the_rest_is_solved_with_it) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 8, 7, random);
    for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(5.0, 50.0);
    auto siemens = random_siemens(array, random, 1e3, 1e5);
    std::vector<std::size_t> held;
    for (int k = 0; k < 5; ++k) held.push_back(random.below(siemens.size()));
    for (const std::size_t k : held) siemens[k] = 0.0;
    auto ratio = ratios_of(array, siemens);
    for (const std::size_t k : held) ratio[k] -= random.uniform(0.001, 0.01);
    std::vector<double> inverted(siemens.size());
    ASSERT_TRUE(inversion_for(array)->invert(ratio, inverted).solved);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      if (siemens[k] == 0.0) {
        ASSERT_EQ(inverted[k], 0.0);
      } else {
        ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-8);
      }
    }
  }
}

TEST_P(FixedPoint, frames_of_a_touch_are_solved_from_the_last_one_as_well_as_from_scratch) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  auto array = random_array(GetParam(), 12, 9, random);
  array.readout.adc_bits = 12;
  for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(5.0, 50.0);
  const double tolerance = 0.01 / 4095.0;
  const auto inversion = inversion_for(array, std::nullopt);
  const auto idle = random_siemens(array, random, 1e5, 1e6);
  std::vector<double> warm(idle.size());
  std::vector<double> cold(idle.size());
  for (int frame = 0; frame < 40; ++frame) {
    auto siemens = idle;
    if (frame >= 10 && frame < 30) siemens[array.index(3, 4)] += 1e-3;  // comes and goes at once
    if (frame >= 15) siemens[array.index(8, 4)] += 1e-4 * (frame - 14);
    auto ratio = ratios_of(array, siemens);
    for (double& reading : ratio) reading = std::round(reading * 4095.0 + random.normal()) / 4095.0;
    const auto result = inversion->invert(ratio, warm);
    ASSERT_TRUE(result.solved) << "frame " << frame;
    ASSERT_LE(misfit(array, ratio, warm), tolerance);
    ASSERT_TRUE(inversion_for(array, 0.0)->invert(ratio, cold).solved);
    for (std::size_t k = 0; k < cold.size(); ++k) {
      ASSERT_NEAR(warm[k], cold[k], 20.0 * tolerance * inversion->siemens_per_ratio()) << "frame " << frame;
    }
  }
}

TEST_P(FixedPoint, open_rows_and_columns_read_zero) {
  Random random(3);
  const auto array = random_array(GetParam(), 6, 5, random);
  auto siemens = random_siemens(array, random);
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    if (k / 5 == 2 || k % 5 == 1) siemens[k] = 0.0;
  }
  // Readings of zero themselves, not within rounding of it.
  auto ratio = ratios_of(array, siemens);
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    if (siemens[k] == 0.0 && std::abs(ratio[k]) < 1e-14) ratio[k] = 0.0;
  }
  std::vector<double> inverted(siemens.size());
  ASSERT_TRUE(inversion_for(array)->invert(ratio, inverted).solved);
  for (std::size_t k = 0; k < siemens.size(); ++k) ASSERT_NEAR(inverted[k], siemens[k], 1e-8 * siemens[k] + 1e-16);
  std::fill(ratio.begin(), ratio.end(), 0.0);
  if (!GetParam().real_amplifiers) {
    ASSERT_TRUE(inversion_for(array)->invert(ratio, inverted).solved);
    EXPECT_EQ(inverted, std::vector<double>(siemens.size(), 0.0));
  }
}

TEST_P(FixedPoint, noise_of_a_taxel_is_that_of_the_exact_jacobian) {
  // Usual arrays: within 5 % for all loaded columns, 10 % where one load is switched.
  const bool one_loaded = GetParam().idle_columns == IdleColumns::floating || GetParam().circuit == Circuit::flexitac;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 12, 10, random);
    for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(1.0, 50.0);
    for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(100.0, 1000.0);
    const auto siemens = random_siemens(array, random, 1e3, 1e5);
    auto model = CircuitModel::create(array);
    model->solve(siemens);
    const auto inversion = inversion_for(array);
    std::vector<double> inverted(siemens.size());
    ASSERT_TRUE(inversion->invert(model->ratio(), inverted).solved);
    constexpr double kSigma = 2e-4;
    std::vector<double> sigma(siemens.size());
    inversion->propagate_noise(kSigma, sigma);
    const std::size_t size = siemens.size();
    std::vector<double> jacobian(size * size);
    model->taxel_jacobian(jacobian);
    std::vector<double> identity(size * size, 0.0);
    for (std::size_t k = 0; k < size; ++k) identity[k * size + k] = 1.0;
    const auto inverse = support::solve(std::move(jacobian), std::move(identity), size);
    for (std::size_t k = 0; k < size; ++k) {
      double square = 0.0;
      for (std::size_t l = 0; l < size; ++l) square += inverse[k * size + l] * inverse[k * size + l];
      ASSERT_NEAR(sigma[k] / (kSigma * std::sqrt(square)), 1.0, one_loaded ? 0.10 : 0.05) << "taxel " << k;
    }
  }
}

TEST_P(FixedPoint, every_instruction_set_gives_the_same) {
  Random random(9);
  const auto array = random_array(GetParam(), 11, 13, random);
  const auto siemens = random_siemens(array, random, 1e3);
  const auto ratio = ratios_of(array, siemens);
  support::for_each_simd_target([&] {
    std::vector<double> inverted(siemens.size());
    std::vector<double> sigma(siemens.size());
    const auto inversion = inversion_for(array);
    ASSERT_TRUE(inversion->invert(ratio, inverted).solved);
    inversion->propagate_noise(1e-4, sigma);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-8);
      ASSERT_GT(sigma[k], 0.0);
    }
  });
}

TEST_P(FixedPoint, garbage_gives_finite_conductances_that_are_not_negative) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::size_t rows = size_between(1, 9, random);
    const auto array = random_array(GetParam(), rows, size_between(1, 9, random), random);
    const auto inversion = inversion_for(array, std::nullopt);
    std::vector<double> ratio(array.taxel_count());
    std::vector<double> inverted(array.taxel_count());
    std::vector<double> sigma(array.taxel_count());
    for (int frame = 0; frame < 4; ++frame) {
      for (double& reading : ratio) {
        reading = seed % 3 == 0 ? random.uniform() : seed % 3 == 1 ? random.uniform(-1.0, 1.2) : 1.0;
      }
      (void)inversion->invert(ratio, inverted);
      inversion->propagate_noise(1e-4, sigma);
      for (std::size_t k = 0; k < ratio.size(); ++k) {
        ASSERT_TRUE(std::isfinite(inverted[k]) && inverted[k] >= 0.0);
        ASSERT_TRUE(std::isfinite(sigma[k]) && sigma[k] >= 0.0);
      }
    }
    const auto good = ratios_of(array, random_siemens(array, random, 1e4, 1e5));
    ASSERT_TRUE(inversion->invert(good, inverted).solved);
  }
}

TEST_P(FixedPoint, nothing_is_allocated_however_hard_the_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(4);
  const auto array = random_array(GetParam(), 16, 16, random);
  const auto inversion = inversion_for(array);
  const auto hard = ratios_of(array, random_siemens(array, random, 50.0, 1e6));
  std::vector<double> inverted(hard.size());
  std::vector<double> garbage(hard.size(), 0.9);
  const support::AllocationGuard guard;
  (void)inversion->invert(hard, inverted);
  (void)inversion->invert(garbage, inverted);
  (void)inversion->invert(hard, inverted);
  inversion->propagate_noise(1e-4, inverted);
  EXPECT_EQ(guard.count(), 0U);
}

// Not every array is given by its readings: this one of 15x14 taxels beside drivers of up to 200 ohm reads the same, to
// the last digit of a double, as another whose conductances are as positive.
TEST(GroundedDivider, two_arrays_can_have_the_same_readings) {
  Random random(6);
  const std::size_t rows = 2 + random.below(19);
  const auto array = random_array({"", Circuit::divider}, rows, 2 + random.below(19), random);
  const auto siemens = random_siemens(array, random);
  const auto ratio = ratios_of(array, siemens);
  std::vector<double> other(siemens.size());
  const auto result = inversion_for(array)->invert(ratio, other);
  ASSERT_TRUE(result.solved);
  EXPECT_LE(result.residual_ratio, 1e-14);
  EXPECT_GT(*std::min_element(other.begin(), other.end()), 0.0);
  const auto other_ratio = ratios_of(array, other);
  double difference = 0.0;
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    EXPECT_NEAR(other_ratio[k], ratio[k], 1e-14);
    difference = std::max(difference, std::abs(other[k] / siemens[k] - 1.0));
  }
  EXPECT_GT(difference, 1.0);
}

}  // namespace
}  // namespace dermis::touch::compensation
