// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The standard deviation of a weighted sum of conductances, beside what the inversion makes of readings, a supply and
// drivers that are wrong by a little.
#include "touch/compensation/shared_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/inversion_campaign.hpp"

namespace dermis::touch::compensation {
namespace {

using support::model_ratios;
using support::NamedCircuit;
using support::random_siemens;

constexpr double kRatioStep = 1e-7;
constexpr double kErrorOhm = 0.01;
constexpr std::uint64_t kSeeds = 20;

std::vector<NamedCircuit> grounded_circuits() {
  std::vector<NamedCircuit> circuits;
  for (const NamedCircuit& circuit : support::all_circuits()) {
    const bool is_virtual = circuit.circuit == Circuit::transimpedance && !circuit.real_amplifiers;
    const bool is_grounded = circuit.idle_rows == IdleRows::grounded || is_virtual;
    if (is_grounded && !circuit.resistive_lines) circuits.push_back(circuit);
  }
  return circuits;
}

/// Of the sum over the taxels that count.
double variance(const SharedErrors& shared, const ConductanceErrors& errors, const std::vector<double>& weights) {
  std::vector<std::size_t> taxels;
  std::vector<double> weight;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (weights[k] == 0.0) continue;
    taxels.push_back(k);
    weight.push_back(weights[k]);
  }
  const WeightedConductances sum{taxels, weight};
  double found = 0.0;
  shared.variances(errors, {&sum, 1}, {&found, 1});
  return found;
}

/// An array, what its taxels conduct and count in a sum.
struct Case {
  Case(const NamedCircuit& circuit, std::uint64_t seed) : random(seed), array(array_of(circuit, random)) {
    siemens = random_siemens(array, random, 1e3, 1e5);
    ratio = model_ratios(array, siemens);
    for (std::size_t k = 0; k < siemens.size(); ++k) weight.push_back(k % 3 == 0 ? 0.0 : random.uniform(0.5, 2.0));
  }

  static ArrayDescription array_of(const NamedCircuit& circuit, Random& random) {
    ArrayDescription array = support::random_array(circuit, 2 + random.below(6), 2 + random.below(6), random);
    for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(0.05, 50.0);
    for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(100.0, 1000.0);
    for (double& volts : array.readout.amplifier_offset_v) volts *= 0.1;
    return array;
  }

  /// The weighted sum that the inversion makes of other readings, with the drivers of `of`.
  [[nodiscard]] double sum(const ArrayDescription& of, const std::vector<double>& readings) const {
    std::vector<double> found(siemens.size());
    EXPECT_TRUE((*make_crosstalk_inversion(of, {0.0}))->invert(readings, found).solved);
    return std::inner_product(weight.begin(), weight.end(), found.begin(), 0.0);
  }
  [[nodiscard]] double slope(const std::vector<double>& above, const std::vector<double>& below) const {
    return (sum(array, above) - sum(array, below)) / (2.0 * kRatioStep);
  }

  [[nodiscard]] std::size_t driven_line(std::size_t taxel) const {
    return driven_axis(array) == Axis::row ? taxel / array.cols : taxel % array.cols;
  }
  [[nodiscard]] double sigma(const ConductanceErrors& errors) const {
    return std::sqrt(variance(SharedErrors(array), errors, weight));
  }
  [[nodiscard]] ConductanceErrors errors() const {
    ConductanceErrors errors;
    errors.siemens.assign(siemens.begin(), siemens.end());
    return errors;
  }

  Random random;
  ArrayDescription array;
  std::vector<double> siemens;
  std::vector<double> ratio;
  std::vector<double> weight;
};

class SharedErrorsOf : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(SharedErrors, SharedErrorsOf, testing::ValuesIn(grounded_circuits()),
                         [](const auto& info) { return info.param.name; });

TEST_P(SharedErrorsOf, noise_of_a_sum_is_what_the_inversion_makes_of_each_reading) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Case made(GetParam(), seed);
    double variance = 0.0;
    for (std::size_t k = 0; k < made.ratio.size(); ++k) {
      std::vector<double> above = made.ratio;
      std::vector<double> below = made.ratio;
      above[k] += kRatioStep;
      below[k] -= kRatioStep;
      variance += std::pow(made.slope(above, below), 2);
    }
    ConductanceErrors errors = made.errors();
    errors.sigma_ratio = 1e-3;
    EXPECT_NEAR(made.sigma(errors) / (1e-3 * std::sqrt(variance)), 1.0, 0.1) << "seed " << seed;
  }
}

/// Hum of a phase that turns from line to line: a cosine and a sine over the driven lines.
TEST_P(SharedErrorsOf, hum_moves_the_sum_as_the_inversion_does) {
  std::size_t off = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Case made(GetParam(), seed);
    const double turn = made.random.uniform(0.0, 1.0);
    double square = 0.0;
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
      std::vector<double> above = made.ratio;
      std::vector<double> below = made.ratio;
      for (std::size_t k = 0; k < above.size(); ++k) {
        const double hum = kRatioStep * std::cos(turn * static_cast<double>(made.driven_line(k)) - phase);
        above[k] += hum;
        below[k] -= hum;
      }
      square += std::pow(made.slope(above, below), 2);
    }
    ConductanceErrors errors = made.errors();
    errors.sigma_ratio = 1e-3;
    for (std::size_t line = 0; line < made.array.driven_lines(); ++line) {
      errors.shared_noise.push_back(static_cast<float>(std::cos(turn * static_cast<double>(line))));
    }
    off += std::abs(made.sigma(errors) / (1e-3 * std::sqrt(square)) - 1.0) > 0.15 ? 1 : 0;
  }
  EXPECT_LE(off, 1) << "of " << kSeeds << " arrays, seeds 1 to " << kSeeds;
}

TEST_P(SharedErrorsOf, hum_widens_each_taxel_as_it_widens_its_sum) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Case made(GetParam(), seed);
    ConductanceErrors errors = made.errors();
    errors.sigma_ratio = 1e-3;
    errors.shared_noise.assign(made.array.driven_lines(), 0.6F);
    const SharedErrors shared(made.array);
    std::vector<double> sigma(made.siemens.size());
    for (std::size_t k = 0; k < sigma.size(); ++k) {
      std::vector<double> alone(sigma.size());
      alone[k] = 1.0;
      ConductanceErrors independent = errors;
      independent.shared_noise.clear();
      sigma[k] = std::sqrt(variance(shared, independent, alone));
    }
    shared.share_noise(errors, sigma);
    for (std::size_t k = 0; k < sigma.size(); ++k) {
      std::vector<double> alone(sigma.size());
      alone[k] = 1.0;
      EXPECT_NEAR(sigma[k] / std::sqrt(variance(shared, errors, alone)), 1.0, 1e-6) << "seed " << seed;
    }
  }
}

TEST_P(SharedErrorsOf, a_wrong_supply_moves_the_sum_as_the_inversion_does) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Case made(GetParam(), seed);
    if (GetParam().real_amplifiers) return;  // whose offsets do not follow the supply
    std::vector<double> above = made.ratio;
    std::vector<double> below = made.ratio;
    for (double& value : above) value *= 1.0 + kRatioStep;
    for (double& value : below) value *= 1.0 - kRatioStep;
    ConductanceErrors errors = made.errors();
    errors.supply_doubt = 0.04;
    made.array.readout.adc_reference_v = 5.0;
    made.array.readout.supply_noise = 0.03;
    EXPECT_NEAR(made.sigma(errors) / (0.05 * std::abs(made.slope(above, below))), 1.0, 0.15) << "seed " << seed;
  }
}

TEST_P(SharedErrorsOf, wrong_drivers_move_the_sum_as_the_inversion_does) {
  std::size_t off = 0;
  for (const double correlation : {0.0, 1.0}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Case made(GetParam(), seed);
      double common = 0.0;
      double square = 0.0;
      for (std::size_t driver = 0; driver < made.array.driven_lines(); ++driver) {
        ArrayDescription above = made.array;
        ArrayDescription below = made.array;
        above.readout.drive_ohm[driver] += kErrorOhm;
        below.readout.drive_ohm[driver] -= kErrorOhm;
        double change = 0.5 * (made.sum(above, made.ratio) - made.sum(below, made.ratio));
        for (std::size_t k = 0; k < made.siemens.size(); ++k) {
          const bool is_column = made.array.readout.circuit == Circuit::flexitac;
          const bool is_own = driver == (is_column ? k % made.array.cols : k / made.array.cols);
          if (is_own) change -= made.weight[k] * kErrorOhm * made.siemens[k] * made.siemens[k];
        }
        common += change;
        square += change * change;
      }
      made.array.readout.drive_error_ohm.assign(made.array.driven_lines(), kErrorOhm);
      made.array.readout.drive_error_correlation = correlation;
      const double expected = correlation == 0.0 ? std::sqrt(square) : std::abs(common);
      const double error = made.sigma(made.errors()) - expected;
      off += std::abs(error) > 0.15 * std::max(expected, std::sqrt(square)) ? 1 : 0;
    }
  }
  EXPECT_LE(off, 2) << "of " << 2 * kSeeds << " arrays, seeds 1 to " << kSeeds;
}

TEST_P(SharedErrorsOf, an_estimated_taxel_moves_those_of_its_lines) {
  Case made(GetParam(), 1);
  constexpr std::size_t kEstimated = 3;  // which counts in no sum
  std::fill(made.weight.begin(), made.weight.end(), 1.0);
  made.weight[kEstimated] = 0.0;
  const double change = 1e-3 * made.siemens[kEstimated];
  ConductanceErrors errors = made.errors();
  errors.doubt_siemens.assign(made.siemens.size(), 0.0F);
  errors.doubt_siemens[kEstimated] = static_cast<float>(change);
  const auto solved = [&](double taken) {
    std::vector<double> found(made.siemens.size(), taken);
    std::vector<double> readings = made.ratio;
    readings[kEstimated] = std::nan("");
    EXPECT_TRUE((*make_crosstalk_inversion(made.array, {0.0}))->invert(readings, found).solved);
    return std::inner_product(made.weight.begin(), made.weight.end(), found.begin(), 0.0);
  };
  const double expected = solved(made.siemens[kEstimated] + change) - solved(made.siemens[kEstimated] - change);
  const double ratio = made.sigma(errors) / (0.5 * std::abs(expected));  // of the first order, as FaultInversion has it
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2.5);
}

TEST_P(SharedErrorsOf, nothing_is_allocated_for_a_second_sum) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const Case made(GetParam(), 1);
  const SharedErrors shared(made.array);
  const ConductanceErrors errors = made.errors();
  std::vector<std::size_t> taxels(made.weight.size());
  std::iota(taxels.begin(), taxels.end(), std::size_t{0});
  const WeightedConductances sum{taxels, made.weight};
  double first = 0.0;
  double second = 0.0;
  shared.variances(errors, {&sum, 1}, {&first, 1});
  const support::AllocationGuard guard;
  shared.variances(errors, {&sum, 1}, {&second, 1});
  EXPECT_EQ(second, first);
  EXPECT_EQ(guard.count(), 0);
}

TEST(SharedErrors, floating_rows_leave_the_noise_to_the_taxels) {
  ArrayDescription array;
  array.rows = 1;
  array.cols = 2;
  array.readout.idle_rows = IdleRows::floating;
  array.readout.drive_ohm = {10.0};
  array.readout.load_ohm = {100.0, 100.0};
  const SharedErrors shared(array);
  ConductanceErrors errors;
  errors.siemens = {1e-3F, 1e-3F};
  errors.noise_siemens = {3e-6F, 4e-6F};
  errors.sigma_ratio = 1.0;
  EXPECT_FALSE(shared.tells_noise());
  EXPECT_NEAR(variance(shared, errors, {1.0, 1.0}), 25e-12, 1e-17);
}

}  // namespace
}  // namespace dermis::touch::compensation
