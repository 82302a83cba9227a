// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The scatter of the inversion under the noise of a 12-bit ADC beside the Cramer-Rao bound,
// sigma sqrt(diag((J^T J)^-1)): no unbiased estimate of the conductances scatters less.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/dense_solve.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr int kDraws = 300;
const double kSigmaCounts = std::sqrt(1.0 + 1.0 / 12.0);  // noise of 1 count and rounding

ArrayDescription random_array(std::size_t lines, Circuit circuit, Random& random) {
  ArrayDescription array;
  array.rows = lines;
  array.cols = lines;
  array.readout.circuit = circuit;
  for (std::size_t k = 0; k < lines; ++k) array.readout.drive_ohm.push_back(random.uniform(5.0, 50.0));
  for (std::size_t k = 0; k < lines; ++k) array.readout.load_ohm.push_back(random.log_uniform(100.0, 1000.0));
  return array;
}

/// Standard deviation of every taxel at the bound [S].
std::vector<double> bound(CircuitModel& circuit, std::size_t taxels, double sigma_ratio) {
  std::vector<double> jacobian(taxels * taxels);
  circuit.taxel_jacobian(jacobian);
  std::vector<double> identity(taxels * taxels, 0.0);
  for (std::size_t k = 0; k < taxels; ++k) identity[k * taxels + k] = 1.0;
  const std::vector<double> inverse = support::solve(std::move(jacobian), std::move(identity), taxels);
  std::vector<double> sigma(taxels);
  for (std::size_t k = 0; k < taxels; ++k) {
    double square = 0.0;
    for (std::size_t j = 0; j < taxels; ++j) square += inverse[k * taxels + j] * inverse[k * taxels + j];
    sigma[k] = sigma_ratio * std::sqrt(square);
  }
  return sigma;
}

/// Root mean square errors over the bound.
struct Ratios {
  std::vector<double> of_taxel;   ///< Of taxels never held at 0 S.
  std::vector<double> predicted;  ///< propagate_noise() over the bound.
  double overall = 0.0;
  double worst_held = 0.0;  ///< Of taxels held at 0 S in some draw: they do better than the bound.
};

Ratios measure(const ArrayDescription& array, Random& random) {
  const std::size_t taxels = array.taxel_count();
  auto circuit = CircuitModel::create(array);
  auto inversion = make_crosstalk_inversion(array);
  std::vector<double> truth(taxels);
  for (double& siemens : truth) siemens = 1.0 / random.log_uniform(1e3, 1e5);
  circuit->solve(truth);
  const std::vector<double> ratio(circuit->ratio().begin(), circuit->ratio().end());
  const double full_scale = array.readout.full_scale_counts();
  const std::vector<double> sigma = bound(*circuit, taxels, kSigmaCounts / full_scale);

  std::vector<double> square(taxels, 0.0);
  std::vector<bool> held(taxels, false);
  std::vector<double> noisy(taxels);
  std::vector<double> siemens(taxels);
  for (int draw = 0; draw < kDraws; ++draw) {
    for (std::size_t k = 0; k < taxels; ++k) {
      noisy[k] = std::clamp(std::round(ratio[k] * full_scale + random.normal()), 0.0, full_scale) / full_scale;
    }
    EXPECT_TRUE((*inversion)->invert(noisy, siemens).solved);
    for (std::size_t k = 0; k < taxels; ++k) {
      held[k] = held[k] || siemens[k] == 0.0;
      square[k] += std::pow((siemens[k] - truth[k]) / sigma[k], 2) / kDraws;
    }
  }
  Ratios ratios;
  double sum = 0.0;
  std::vector<double> predicted(taxels);
  EXPECT_TRUE((*inversion)->invert(ratio, siemens).solved);
  (*inversion)->propagate_noise(kSigmaCounts / full_scale, predicted);
  for (std::size_t k = 0; k < taxels; ++k) {
    ratios.predicted.push_back(predicted[k] / sigma[k]);
    if (held[k]) {
      ratios.worst_held = std::max(ratios.worst_held, std::sqrt(square[k]));
      continue;
    }
    ratios.of_taxel.push_back(std::sqrt(square[k]));
    sum += square[k];
  }
  ratios.overall = std::sqrt(sum / static_cast<double>(ratios.of_taxel.size()));
  std::sort(ratios.of_taxel.begin(), ratios.of_taxel.end());
  std::sort(ratios.predicted.begin(), ratios.predicted.end());
  return ratios;
}

TEST(CramerRao, the_inversion_reaches_the_bound_under_the_noise_of_the_adc) {
  double worst_overall = 0.0;
  double worst_taxel = 0.0;
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << to_string(circuit) << ", seed " << seed);
      Random random(seed);
      const Ratios ratios = measure(random_array(16, circuit, random), random);
      const double median = ratios.of_taxel[ratios.of_taxel.size() / 2];
      EXPECT_GT(ratios.of_taxel.size(), 128U);
      EXPECT_LT(ratios.overall, 1.05);
      EXPECT_GT(ratios.overall, 0.95);
      EXPECT_NEAR(median, 1.0, 0.03);
      EXPECT_LT(ratios.of_taxel.back(), 1.0 + 5.0 / std::sqrt(2.0 * kDraws));  // its own scatter, 5 deviations
      EXPECT_LT(ratios.worst_held, 1.2);
      worst_overall = std::max(worst_overall, ratios.overall);
      worst_taxel = std::max(worst_taxel, ratios.of_taxel.back());
      const double predicted_median = ratios.predicted[ratios.predicted.size() / 2];
      RecordProperty(std::string("predicted_over_bound_") + to_string(circuit) + std::to_string(seed),
                     std::to_string(ratios.predicted.front()) + " " + std::to_string(predicted_median) + " " +
                         std::to_string(ratios.predicted.back()));
    }
  }
  RecordProperty("worst_overall_ratio", std::to_string(worst_overall));
  RecordProperty("worst_taxel_ratio", std::to_string(worst_taxel));
}

/// The Compensator's standard deviation where hardly anything but the supply is wrong, over what the inversion makes of
/// readings that are all wrong by that share; the greatest and the smallest over the taxels.
std::pair<double, double> supply_sigma_over_error(ArrayDescription array, Random& random) {
  const std::size_t taxels = array.taxel_count();
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  array.readout.supply_noise = 1e-4;
  std::vector<double> truth(taxels);
  for (double& siemens : truth) siemens = random.below(4) == 0 ? 1.0 / random.log_uniform(200.0, 2000.0) : 5e-6;
  auto circuit = CircuitModel::create(array);
  circuit->solve(truth);
  ConditionedFrame conditioned;
  conditioned.ratio.assign(circuit->ratio().begin(), circuit->ratio().end());
  conditioned.sigma_ratio = 1e-12;
  conditioned.taxels.assign(taxels, TaxelStatus::ok);
  ConductanceFrame right;
  auto compensator = Compensator::create(array);
  compensator->process(conditioned, right);
  const InversionOptions exact{0.0};
  auto inversion = make_crosstalk_inversion(array, exact);
  std::vector<double> wrong(taxels);
  for (double& ratio : conditioned.ratio) ratio *= 1.0 + 1e-4;
  EXPECT_TRUE((*inversion)->invert(conditioned.ratio, wrong).solved);
  std::pair<double, double> range{1e9, 0.0};
  for (std::size_t k = 0; k < taxels; ++k) {
    if (truth[k] < 1e-4) continue;
    const double share = right.sigma_siemens[k] / std::abs(wrong[k] - truth[k]);
    range = {std::min(range.first, share), std::max(range.second, share)};
  }
  return range;
}

TEST(SupplyError, is_what_the_inversion_makes_of_a_wrong_supply) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(testing::Message() << to_string(circuit) << ", seed " << seed);
      Random random(seed);
      ArrayDescription array = random_array(8, circuit, random);
      const auto [low, high] = supply_sigma_over_error(array, random);
      EXPECT_GT(low, 0.6);
      EXPECT_LT(high, 1.6);
      array.readout.drive_ohm.assign(8, circuit == Circuit::divider ? 1e-3 : 20.0);
      const auto [ideal_low, ideal_high] = supply_sigma_over_error(array, random);
      EXPECT_NEAR(ideal_low, 1.0, 2e-3);
      EXPECT_NEAR(ideal_high, 1.0, 2e-3);
    }
  }
}

TEST(SupplyError, of_a_doubted_supply_is_that_of_so_much_noise) {
  Random random(2);
  ArrayDescription array = random_array(4, Circuit::divider, random);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  ConditionedFrame conditioned;
  conditioned.ratio.assign(16, 0.05);
  conditioned.sigma_ratio = 1e-6;
  conditioned.taxels.assign(16, TaxelStatus::ok);
  ConductanceFrame noisy;
  array.readout.supply_noise = 0.05;
  Compensator::create(array)->process(conditioned, noisy);
  ConductanceFrame doubted;
  array.readout.supply_noise = 0.03;
  conditioned.supply_doubt = 0.04;
  Compensator::create(array)->process(conditioned, doubted);
  for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(doubted.sigma_siemens[k] / noisy.sigma_siemens[k], 1.0, 1e-9);
}

TEST(SupplyError, is_nothing_where_the_reference_is_the_supply) {
  Random random(1);
  ArrayDescription array = random_array(4, Circuit::divider, random);
  array.readout.supply_noise = 0.05;
  ConditionedFrame conditioned;
  conditioned.ratio.assign(16, 0.05);
  conditioned.sigma_ratio = 1e-6;
  conditioned.taxels.assign(16, TaxelStatus::ok);
  ConductanceFrame with;
  ConductanceFrame without;
  Compensator::create(array)->process(conditioned, with);
  array.readout.supply_noise = 0.0;
  Compensator::create(array)->process(conditioned, without);
  EXPECT_EQ(with.sigma_siemens, without.sigma_siemens);
}

}  // namespace
}  // namespace dermis::touch::compensation
