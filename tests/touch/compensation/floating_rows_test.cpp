// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/floating_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kEnough = 1e-8;
constexpr double kMostOhm = 1e5;

ArrayDescription random_floating_array(std::size_t rows, std::size_t cols, Random& random) {
  auto array = support::random_array({"", Circuit::divider, IdleRows::floating}, rows, cols, random);
  for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(100.0, 2000.0);
  return array;
}

std::vector<double> random_taxels(const ArrayDescription& array, Random& random) {
  return support::random_siemens(array, random, 500.0, kMostOhm);
}

std::vector<double> ratios_of(const ArrayDescription& array, const std::vector<double>& siemens) {
  auto model = CircuitModel::create(array);
  EXPECT_TRUE(model);
  model->solve(siemens);
  return {model->ratio().begin(), model->ratio().end()};
}

TEST(FloatingRows, every_taxel_of_random_arrays_comes_back) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::size_t rows = 2 + random.below(31);
    const auto array = random_floating_array(rows, 2 + random.below(31), random);
    ASSERT_TRUE(FloatingRows::inverts(array.readout));
    const auto siemens = random_taxels(array, random);
    const auto ratio = ratios_of(array, siemens);
    FloatingRows floating_rows(array);
    std::vector<double> inverted(siemens.size());
    ASSERT_TRUE(floating_rows.allows(ratio));
    ASSERT_LE(floating_rows.solve(ratio, kEnough, inverted), kEnough);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-5) << array.taxel_name(k);
    }
  }
}

TEST(FloatingRows, a_reading_below_what_the_neighbours_cause_gives_zero_and_the_rest_is_solved_with_it) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = random_floating_array(9, 8, random);
    auto siemens = random_taxels(array, random);
    std::vector<std::size_t> held;
    for (int k = 0; k < 5; ++k) held.push_back(random.below(siemens.size()));
    for (const std::size_t k : held) siemens[k] = 0.0;
    auto ratio = ratios_of(array, siemens);
    for (const std::size_t k : held) ratio[k] *= 1.0 - random.uniform(0.001, 0.1);
    std::vector<double> inverted(siemens.size());
    ASSERT_LE(FloatingRows(array).solve(ratio, kEnough, inverted), kEnough);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      if (siemens[k] == 0.0) {
        ASSERT_EQ(inverted[k], 0.0);
      } else {
        ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-5);
      }
    }
  }
}

TEST(FloatingRows, a_touch_is_solved_from_the_last_frame_as_from_scratch) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const auto array = random_floating_array(12, 9, random);
  const auto idle = random_taxels(array, random);
  FloatingRows warm(array);
  std::vector<double> from_last(idle.size());
  std::vector<double> from_scratch(idle.size());
  for (int frame = 0; frame < 20; ++frame) {
    auto siemens = idle;
    if (frame >= 5 && frame < 15) siemens[array.index(3, 4)] += 1e-3;
    const auto ratio = ratios_of(array, siemens);
    ASSERT_LE(warm.solve(ratio, kEnough, from_last), kEnough) << "frame " << frame;
    ASSERT_LE(FloatingRows(array).solve(ratio, kEnough, from_scratch), kEnough) << "frame " << frame;
    for (std::size_t k = 0; k < idle.size(); ++k) ASSERT_NEAR(from_last[k] / from_scratch[k], 1.0, 1e-6);
  }
}

TEST(FloatingRows, open_rows_and_columns_read_zero) {
  Random random(3);
  const auto array = random_floating_array(6, 5, random);
  auto siemens = random_taxels(array, random);
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    if (k / 5 == 2 || k % 5 == 1) siemens[k] = 0.0;
  }
  const auto ratio = ratios_of(array, siemens);
  std::vector<double> inverted(siemens.size());
  ASSERT_LE(FloatingRows(array).solve(ratio, kEnough, inverted), kEnough);
  for (std::size_t k = 0; k < siemens.size(); ++k) ASSERT_NEAR(inverted[k], siemens[k], 1e-6 * siemens[k] + 1e-15);
  ASSERT_LE(FloatingRows(array).solve(std::vector<double>(siemens.size()), kEnough, inverted), kEnough);
  EXPECT_EQ(inverted, std::vector<double>(siemens.size()));
}

TEST(FloatingRows, every_taxel_comes_back_under_a_film) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_floating_array(2 + random.below(15), 2 + random.below(15), random);
    const double ohm = random.log_uniform(2e4, 1e6);
    array.readout.film = Film{ohm, ohm};
    const auto siemens = random_taxels(array, random);
    std::vector<double> inverted(siemens.size());
    ASSERT_LE(FloatingRows(array).solve(ratios_of(array, siemens), kEnough, inverted), kEnough);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      ASSERT_NEAR(inverted[k] / siemens[k], 1.0, 1e-4) << array.taxel_name(k);
    }
  }
}

TEST(FloatingRows, refuses_readings_that_no_driver_carries) {
  Random random(1);
  auto array = random_floating_array(4, 4, random);
  array.readout.drive_ohm.assign(4, 100.0);
  array.readout.load_ohm.assign(4, 100.0);
  EXPECT_TRUE(FloatingRows(array).allows(std::vector<double>(16, 0.2)));
  EXPECT_FALSE(FloatingRows(array).allows(std::vector<double>(16, 0.26)));
}

TEST(FloatingRows, allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(4);
  const auto array = random_floating_array(32, 32, random);
  const auto ratio = ratios_of(array, random_taxels(array, random));
  const std::vector<double> garbage(ratio.size(), 0.9);
  FloatingRows floating_rows(array);
  std::vector<double> inverted(ratio.size());
  const support::AllocationGuard guard;
  (void)floating_rows.solve(ratio, kEnough, inverted);
  (void)floating_rows.solve(garbage, kEnough, inverted);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::touch::compensation
