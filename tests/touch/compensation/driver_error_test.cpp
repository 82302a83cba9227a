// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The standard deviation that drivers of uncertain resistance give, beside what the inversion makes of the same
// readings with drivers that are wrong by so much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/inversion_campaign.hpp"

namespace dermis::touch::compensation {
namespace {

using support::model_ratios;
using support::NamedCircuit;
using support::random_siemens;

constexpr double kErrorOhm = 0.01;

class DriverErrorOf : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(DriverError, DriverErrorOf, testing::ValuesIn(support::all_circuits()),
                         [](const auto& info) { return info.param.name; });

/// Whether the formula of docs/reasons/derivations-circuits.md stands for the derivatives: exact for ideal drivers
/// only.
bool is_approximate(const NamedCircuit& circuit) {
  const bool at_ground = circuit.circuit == Circuit::transimpedance && !circuit.real_amplifiers;
  return circuit.idle_rows == IdleRows::grounded && !circuit.resistive_lines && !at_ground;
}

ArrayDescription array_of(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, double most_drive_ohm,
                          Random& random) {
  ArrayDescription array = support::random_array(circuit, rows, cols, random);
  for (double& ohm : array.readout.drive_ohm) ohm = random.uniform(0.05, most_drive_ohm);
  for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(100.0, 1000.0);
  for (double& volts : array.readout.amplifier_offset_v) volts *= 0.1;
  return array;
}

std::vector<double> inverted(const ArrayDescription& array, const std::vector<double>& ratio) {
  std::vector<double> siemens(ratio.size());
  EXPECT_TRUE((*make_crosstalk_inversion(array, {0.0}))->invert(ratio, siemens).solved);
  return siemens;
}

/// What kErrorOhm of one driver changes of every taxel beyond what it would change of the taxel alone, which is in
/// series with its driver then: 1 / G falls by as much as the driver is taken to be larger.
std::vector<double> change_by(const ArrayDescription& array, std::size_t driver, const std::vector<double>& siemens,
                              const std::vector<double>& ratio) {
  ArrayDescription wrong = array;
  wrong.readout.drive_ohm[driver] = array.readout.drive_ohm[driver] + kErrorOhm;
  const std::vector<double> above = inverted(wrong, ratio);
  wrong.readout.drive_ohm[driver] = array.readout.drive_ohm[driver] - kErrorOhm;
  const std::vector<double> below = inverted(wrong, ratio);
  std::vector<double> change(siemens.size());
  for (std::size_t k = 0; k < change.size(); ++k) {
    const bool is_own = driver == (array.readout.circuit == Circuit::flexitac ? k % array.cols : k / array.cols);
    change[k] = 0.5 * (above[k] - below[k]) - (is_own ? kErrorOhm * siemens[k] * siemens[k] : 0.0);
  }
  return change;
}

struct Expected {
  std::vector<double> sigma;  ///< [S]
  std::vector<double> scale;  ///< That of drivers that err one by one, where errors in common cancel to less than it.
};

Expected expected_sigma(const ArrayDescription& array, double correlation, const std::vector<double>& siemens,
                        const std::vector<double>& ratio) {
  std::vector<double> sum(siemens.size());
  std::vector<double> square(siemens.size());
  for (std::size_t driver = 0; driver < array.driven_lines(); ++driver) {
    const std::vector<double> change = change_by(array, driver, siemens, ratio);
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k] += change[k];
      square[k] += change[k] * change[k];
    }
  }
  Expected expected;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    expected.sigma.push_back(std::sqrt(correlation * sum[k] * sum[k] + (1.0 - correlation) * square[k]));
    expected.scale.push_back(std::max(expected.sigma[k], std::sqrt(square[k])));
  }
  return expected;
}

ConditionedFrame frame_of(const std::vector<double>& ratio) {
  ConditionedFrame conditioned;
  conditioned.ratio = ratio;
  conditioned.sigma_ratio = 1e-12;
  conditioned.taxels.assign(ratio.size(), TaxelStatus::ok);
  return conditioned;
}

Compensator compensator_of(ArrayDescription array, double correlation) {
  array.readout.drive_error_ohm.assign(array.driven_lines(), kErrorOhm);
  array.readout.drive_error_correlation = correlation;
  return *Compensator::create(array);
}

/// By how much the Compensator's standard deviations are off, sorted, where hardly anything but the drivers is unsure.
std::vector<double> errors_of_sigma(const ArrayDescription& array, double correlation, Random& random) {
  const std::vector<double> siemens = random_siemens(array, random, 1e3, 1e5);
  const std::vector<double> ratio = model_ratios(array, siemens);
  ConductanceFrame conductance;
  compensator_of(array, correlation).process(frame_of(ratio), conductance);
  const Expected expected = expected_sigma(array, correlation, siemens, ratio);
  std::vector<double> errors;
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    errors.push_back((conductance.sigma_siemens[k] - expected.sigma[k]) / expected.scale[k]);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST_P(DriverErrorOf, is_what_the_inversion_makes_of_wrong_drivers) {
  const double most = is_approximate(GetParam()) ? 0.15 : 0.02;
  std::size_t off = 0;
  std::size_t taxels = 0;
  for (const double correlation : {0.0, 0.5, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      Random random(seed);
      const std::size_t rows = 2 + random.below(6);
      const std::size_t cols = 2 + random.below(6);
      const ArrayDescription array = array_of(GetParam(), rows, cols, 50.0, random);
      for (const double error : errors_of_sigma(array, correlation, random)) off += std::abs(error) > most ? 1 : 0;
      taxels += array.taxel_count();
    }
  }
  EXPECT_LE(off, is_approximate(GetParam()) ? taxels / 20 : 0) << "of " << taxels << " taxels, seeds 1 to 40";
}

TEST_P(DriverErrorOf, is_exact_for_good_drivers) {
  Random random(1);
  const std::vector<double> errors = errors_of_sigma(array_of(GetParam(), 6, 5, 0.2, random), 0.3, random);
  EXPECT_GT(errors.front(), -0.01);
  EXPECT_LT(errors.back(), 0.01);
}

TEST_P(DriverErrorOf, frames_allocate_nothing_for_it) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(2);
  const ArrayDescription array = array_of(GetParam(), 12, 11, 50.0, random);
  const ConditionedFrame frame = frame_of(model_ratios(array, random_siemens(array, random, 1e3, 1e5)));
  Compensator compensator = compensator_of(array, 0.5);
  ConductanceFrame conductance;
  compensator.process(frame, conductance);
  const support::AllocationGuard guard;
  compensator.process(frame, conductance);
  EXPECT_EQ(guard.count(), 0);
}

TEST(DriverError, of_arrays_whose_noise_is_sampled_scatters_as_twelve_samples_do) {
  Random random(3);
  const NamedCircuit floating{"divider_floating_rows", Circuit::divider, IdleRows::floating};
  const std::vector<double> errors = errors_of_sigma(array_of(floating, 21, 20, 50.0, random), 0.3, random);
  EXPECT_NEAR(errors[errors.size() / 2], 0.0, 0.1);
  EXPECT_GT(errors.front(), -0.7);
  EXPECT_LT(errors.back(), 0.8);
}

}  // namespace
}  // namespace dermis::touch::compensation
