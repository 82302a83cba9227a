// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Every inversion against its forward model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/dense_solve.hpp"
#include "support/inversion_campaign.hpp"

namespace dermis::touch::compensation {
namespace {

using support::campaign_of;
using support::distance;
using support::model_ratios;
using support::NamedCircuit;
using support::random_array;
using support::random_siemens;

class EveryInversion : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(CrosstalkInversion, EveryInversion, testing::ValuesIn(support::all_circuits()),
                         [](const auto& info) { return info.param.name; });

std::unique_ptr<CrosstalkInversion> inversion_for(const ArrayDescription& array, const InversionOptions& options = {}) {
  auto inversion = make_crosstalk_inversion(array, options);
  EXPECT_TRUE(inversion) << inversion.error().message;
  return std::move(*inversion);
}

std::vector<double> simulated_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  learn::simulation::ReadoutCircuit::create(array)->ratios(siemens, ratio);
  return ratio;
}

TEST_P(EveryInversion, returns_every_taxel) {
  struct Size {
    std::size_t rows;
    std::size_t cols;
    int arrays;
  };
  for (const auto& [rows, cols, arrays] :
       {Size{2, 2, 20}, Size{3, 7, 20}, Size{9, 4, 20}, Size{8, 8, 10}, Size{16, 16, 2}}) {
    SCOPED_TRACE(testing::Message() << rows << 'x' << cols << ", seeds 1 to " << arrays);
    EXPECT_EQ(campaign_of(GetParam(), rows, cols, arrays).failed, 0);
  }
}

/// Random contacts on an array that is nearly open elsewhere.
std::vector<double> touched(const ArrayDescription& array, Random& random, double idle_siemens) {
  std::vector<double> siemens(array.taxel_count(), idle_siemens);
  for (int k = 0; k < 5; ++k) siemens[random.below(siemens.size())] = 1.0 / random.log_uniform(500.0, 2e4);
  return siemens;
}

TEST_P(EveryInversion, agrees_with_the_simulator) {
  Random random(1);
  for (const std::size_t size : {2U, 5U, 8U}) {
    SCOPED_TRACE(testing::Message() << size << 'x' << size);
    const auto array = random_array(GetParam(), size, size, random);
    const auto siemens = touched(array, random, 1e-6);
    std::vector<double> inverted(siemens.size());
    EXPECT_TRUE(inversion_for(array, {0.0})->invert(simulated_ratios(array, siemens), inverted).solved);
    EXPECT_LE(distance(inverted, siemens), 1e-6);
  }
}

TEST_P(EveryInversion, agrees_with_the_simulator_behind_a_weak_supply_and_switches) {
  Random random(2);
  for (const std::size_t size : {2U, 5U, 8U}) {
    SCOPED_TRACE(testing::Message() << size << 'x' << size << ", seed 2");
    auto array = random_array(GetParam(), size, size, random);
    array.readout.amplifier_offset_v.clear();
    array.readout.supply_ohm = 10.0;
    const bool shares_a_load =
        array.readout.circuit == Circuit::flexitac || array.readout.idle_columns == IdleColumns::floating;
    if (shares_a_load) array.readout.column_switch_ohm.assign(size, 80.0);
    const auto siemens = touched(array, random, 1e-6);
    const auto ratio = simulated_ratios(array, siemens);
    std::vector<double> inverted(siemens.size());
    EXPECT_TRUE(inversion_for(array, {0.0})->invert(ratio, inverted).solved);
    EXPECT_LE(distance(inverted, siemens), 1e-6);
    const auto model = model_ratios(array, siemens);
    for (std::size_t k = 0; k < ratio.size(); ++k) EXPECT_NEAR(model[k], ratio[k], 1e-9 * std::abs(ratio[k]) + 1e-15);
    array.readout.supply_ohm = 0.0;
    (void)inversion_for(array, {0.0})->invert(ratio, inverted);
    EXPECT_GT(distance(inverted, siemens), 1e-4) << "the supply matters";
  }
}

/// The certificate, computed anew.
double misfit(const ArrayDescription& array, const std::vector<double>& ratio, const std::vector<double>& siemens) {
  const auto model = model_ratios(array, siemens);
  double largest = 0.0;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    const double difference = ratio[k] - model[k];
    largest = std::max(largest, siemens[k] > 0.0 ? std::abs(difference) : difference);
  }
  return largest;
}

void expect_possible(const std::vector<double>& siemens) {
  for (const double value : siemens) ASSERT_TRUE(std::isfinite(value) && value >= 0.0) << value;
}

TEST_P(EveryInversion, noisy_frames_are_solved_within_the_certificate) {
  for (const double idle_siemens : {0.0, 1e-7, 5e-6}) {
    Random random(7);
    auto array = random_array(GetParam(), 8, 8, random);
    array.readout.adc_bits = 12;
    const auto inversion = inversion_for(array);
    std::vector<double> inverted(array.taxel_count());
    for (int frame = 0; frame < 30; ++frame) {
      SCOPED_TRACE(testing::Message() << "seed 7, idle " << idle_siemens << " S, frame " << frame);
      auto ratio = model_ratios(array, touched(array, random, idle_siemens));
      for (double& value : ratio) value = std::round(4095.0 * value + random.normal()) / 4095.0;
      const InversionResult result = inversion->invert(ratio, inverted);
      EXPECT_TRUE(result.solved);
      EXPECT_LE(result.residual_ratio, 0.01 / 4095.0);
      EXPECT_LE(misfit(array, ratio, inverted), result.residual_ratio + 1e-12);
      expect_possible(inverted);
    }
  }
}

TEST_P(EveryInversion, impossible_readings_give_finite_taxels_and_the_right_status) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 1 + random.below(8), 1 + random.below(8), random);
    array.readout.adc_bits = 12;
    std::vector<double> ratio(array.taxel_count());
    for (double& value : ratio) {
      switch (seed % 4) {
        case 0: value = 1.0; break;
        case 1: value = random.uniform(-1.0, 1.2); break;
        case 2: value = static_cast<double>(random.below(2)); break;
        default: value = random.uniform(); break;
      }
    }
    std::vector<double> inverted(ratio.size());
    const auto inversion = inversion_for(array);
    for (int frame = 0; frame < 2; ++frame) {
      const InversionResult result = inversion->invert(ratio, inverted);
      expect_possible(inverted);
      if (result.solved) {
        EXPECT_LE(misfit(array, ratio, inverted), result.residual_ratio + 1e-12);
      }
    }
  }
}

TEST_P(EveryInversion, an_infinite_reading_is_never_solved_and_leaves_no_trace) {
  Random random(2);
  const auto array = random_array(GetParam(), 4, 5, random);
  const std::vector<double> good = model_ratios(array, random_siemens(array, random, 1e3, 1e6));
  const auto inversion = inversion_for(array);
  std::vector<double> expected(good.size());
  ASSERT_TRUE(inversion->invert(good, expected).solved);
  std::vector<double> ratio = good;
  ratio[7] = std::numeric_limits<double>::infinity();
  std::vector<double> inverted(ratio.size());
  EXPECT_FALSE(inversion->invert(ratio, inverted).solved);
  expect_possible(inverted);
  EXPECT_TRUE(inversion->invert(good, inverted).solved);
  EXPECT_LT(distance(inverted, expected), 1e-3);
}

TEST_P(EveryInversion, solves_the_others_with_taxels_that_have_no_reading) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = random_array(GetParam(), 2 + random.below(7), 2 + random.below(7), random);
    const auto inversion = inversion_for(array, {0.0});
    for (int frame = 0; frame < 3; ++frame) {
      const auto siemens = random_siemens(array, random, 1e3, 1e6);
      auto ratio = model_ratios(array, siemens);
      std::vector<double> inverted(ratio.size());
      for (std::size_t k = 0; k < ratio.size() / 4; ++k) {
        const std::size_t taxel = random.below(ratio.size());
        ratio[taxel] = std::numeric_limits<double>::quiet_NaN();
        inverted[taxel] = siemens[taxel];
      }
      EXPECT_TRUE(inversion->invert(ratio, inverted).solved);
      EXPECT_LE(distance(inverted, siemens), 1e-6);
    }
  }
}

TEST_P(EveryInversion, an_open_array_is_zero) {
  Random random(1);
  auto array = random_array(GetParam(), 4, 5, random);
  array.readout.amplifier_offset_v.clear();
  std::vector<double> inverted(20, 1.0);
  EXPECT_TRUE(inversion_for(array, {0.0})->invert(std::vector<double>(20, 0.0), inverted).solved);
  EXPECT_EQ(inverted, std::vector<double>(20, 0.0));
}

TEST_P(EveryInversion, forgets_the_last_frame_to_the_last_bit) {
  Random random(3);
  const auto array = random_array(GetParam(), 6, 5, random);
  const auto first = model_ratios(array, random_siemens(array, random));
  const auto second = model_ratios(array, random_siemens(array, random));
  std::vector<double> fresh(30);
  std::vector<double> later(30);
  EXPECT_TRUE(inversion_for(array)->invert(second, fresh).solved);
  const auto inversion = inversion_for(array);
  EXPECT_TRUE(inversion->invert(first, later).solved);
  inversion->forget();
  EXPECT_TRUE(inversion->invert(second, later).solved);
  EXPECT_EQ(later, fresh);
}

TEST_P(EveryInversion, later_frames_allocate_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(4);
  const auto array = random_array(GetParam(), 16, 16, random);
  const auto inversion = inversion_for(array);
  const auto first = model_ratios(array, touched(array, random, 1e-6));
  const auto second = model_ratios(array, touched(array, random, 1e-6));
  std::vector<double> inverted(256);
  std::vector<double> sigma(256);
  EXPECT_TRUE(inversion->invert(first, inverted).solved);
  inversion->propagate_noise(1e-4, sigma);
  const support::AllocationGuard guard;
  EXPECT_TRUE(inversion->invert(second, inverted).solved);
  inversion->propagate_noise(1e-4, sigma);
  EXPECT_EQ(guard.count(), 0);
}

/// sigma_ratio times the norms of the rows of (d ratio / d siemens)^-1.
std::vector<double> noise_of(const ArrayDescription& array, const std::vector<double>& siemens, double sigma_ratio) {
  const std::size_t size = siemens.size();
  std::vector<double> jacobian(size * size);
  std::vector<double> identity(size * size, 0.0);
  auto model = CircuitModel::create(array);
  model->solve(siemens);
  model->taxel_jacobian(jacobian);
  for (std::size_t k = 0; k < size; ++k) identity[k * size + k] = 1.0;
  const auto inverse = support::solve(std::move(jacobian), std::move(identity), size);
  std::vector<double> sigma(size, 0.0);
  for (std::size_t k = 0; k < size; ++k) {
    for (std::size_t l = 0; l < size; ++l) sigma[k] += inverse[k * size + l] * inverse[k * size + l];
    sigma[k] = sigma_ratio * std::sqrt(sigma[k]);
  }
  return sigma;
}

TEST_P(EveryInversion, noise_becomes_what_the_jacobian_says) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 4 + random.below(5), 4 + random.below(5), random);
    for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(1.0, 50.0);
    for (double& ohm : array.readout.load_ohm) ohm = random.uniform(100.0, 1000.0);
    const auto siemens = random_siemens(array, random, 1e3, 1e5);
    std::vector<double> inverted(siemens.size());
    std::vector<double> sigma(siemens.size());
    const auto inversion = inversion_for(array, {0.0});
    EXPECT_TRUE(inversion->invert(model_ratios(array, siemens), inverted).solved);
    inversion->propagate_noise(1e-4, sigma);
    const auto expected = noise_of(array, siemens, 1e-4);
    for (std::size_t k = 0; k < sigma.size(); ++k) EXPECT_NEAR(sigma[k] / expected[k], 1.0, 0.1) << "taxel " << k;
  }
}

TEST(NewtonInversion, leaves_a_frame_unsolved_after_the_steps_that_it_may_take) {
  Random random(1);
  const NamedCircuit circuit{.name = "divider_resistive_lines", .resistive_lines = true};
  const auto array = random_array(circuit, 6, 6, random);
  const auto ratio = model_ratios(array, random_siemens(array, random));
  std::vector<double> inverted(ratio.size());
  InversionOptions options;
  options.most_steps = 1;
  const auto hasty = inversion_for(array, options);
  for (int frame = 0; frame < 2; ++frame) EXPECT_FALSE(hasty->invert(ratio, inverted).solved);
  options.most_steps = 50;
  EXPECT_TRUE(inversion_for(array, options)->invert(ratio, inverted).solved);
}

TEST(LargeInversion, floating_rows_and_resistive_lines_come_back) {
  for (const NamedCircuit& circuit : support::all_circuits()) {
    if (circuit.name != "divider_floating_rows" && circuit.name != "divider_floating_rows_resistive_lines") continue;
    SCOPED_TRACE(circuit.name);
    EXPECT_EQ(campaign_of(circuit, 32, 32, 1).failed, 0);
    if (!circuit.resistive_lines) {
      EXPECT_EQ(campaign_of(circuit, 64, 64, 1).failed, 0);
    }
  }
}

}  // namespace
}  // namespace dermis::touch::compensation
