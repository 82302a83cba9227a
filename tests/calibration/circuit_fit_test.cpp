// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/circuit_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/simulated.hpp"
#include "dermis/calibration/calibrate.hpp"
#include "dermis/calibration/evaluation.hpp"
#include "dermis/core/parallel.hpp"
#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

/// 20 ohm drivers and 200 ohm loads, each with 10 % of its own.
ArrayDescription uneven_array(std::size_t lines, std::uint64_t seed) {
  ArrayDescription array = reference_array(lines, lines);
  Random random(seed);
  for (double& ohm : array.readout.drive_ohm) ohm *= std::exp(0.1 * random.normal());
  for (double& ohm : array.readout.load_ohm) ohm *= std::exp(0.1 * random.normal());
  return array;
}

/// Only the first load is known.
ArrayDescription to_be_fitted(ArrayDescription array) {
  array.readout.drive_ohm.assign(array.readout.drive_ohm.size(), kFitOhm);
  std::fill(array.readout.load_ohm.begin() + 1, array.readout.load_ohm.end(), kFitOhm);
  return array;
}

double worst_error(const std::vector<double>& found, const std::vector<double>& truth) {
  double worst = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) worst = std::max(worst, std::abs(found[k] / truth[k] - 1.0));
  return worst;
}

/// Root mean square of the errors in their own standard errors: near 1 where those are honest.
double rms_in_standard_errors(const std::vector<double>& found, const std::vector<double>& truth,
                              const std::vector<double>& sigma) {
  double square = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (sigma[k] == 0.0) continue;
    square += std::pow((found[k] / truth[k] - 1.0) / sigma[k], 2);
    count += 1.0;
  }
  return std::sqrt(square / count);
}

bool says(const CircuitFit& fit, const std::string& words) {
  return std::any_of(fit.statements.begin(), fit.statements.end(),
                     [&](const std::string& statement) { return statement.find(words) != std::string::npos; });
}

CircuitFit fit_of(const ArrayDescription& array, const Recording& recording) {
  auto fit = fit_circuit(array, recording.frames, recording.loads);
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

simulation::SimulationOptions leaky_rubber() {
  simulation::SimulationOptions options;
  options.rubber.unloaded_ohm = 20e3;
  return options;
}

TEST(CircuitFit, finds_each_resistance_to_two_percent_under_uniform_loads) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const ArrayDescription truth = uneven_array(8, seed);
    const CircuitFit fit = fit_of(to_be_fitted(truth), record(truth, "uniform", seed, leaky_rubber()));
    EXPECT_LE(worst_error(fit.array.readout.drive_ohm, truth.readout.drive_ohm), 0.02);
    EXPECT_LE(worst_error(fit.array.readout.load_ohm, truth.readout.load_ohm), 0.02);
    EXPECT_EQ(fit.array.readout.load_ohm[0], truth.readout.load_ohm[0]);
    EXPECT_EQ(fit.load_error[0], 0.0);
    EXPECT_FALSE(fit.array.has_unknown_circuit());
  }
}

TEST(CircuitFit, is_as_good_with_single_presses_as_it_says) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    const ArrayDescription truth = uneven_array(8, seed);
    const CircuitFit fit = fit_of(to_be_fitted(truth), record(truth, "calibration", seed));
    EXPECT_LT(rms_in_standard_errors(fit.array.readout.drive_ohm, truth.readout.drive_ohm, fit.drive_error), 2.0);
    EXPECT_LT(rms_in_standard_errors(fit.array.readout.load_ohm, truth.readout.load_ohm, fit.load_error), 2.0);
    EXPECT_LE(worst_error(fit.array.readout.load_ohm, truth.readout.load_ohm), 0.02);
    EXPECT_TRUE(says(fit, "uniform load")) << "which recording would help";
  }
}

TEST(CircuitFit, gives_forces_as_good_as_the_known_circuit) {
  const ArrayDescription truth = uneven_array(8, 4);
  const Recording recording = record(truth, "calibration", 1);
  const auto known = calibrate(truth, recording.frames, recording.loads);
  const auto fitted = calibrate(to_be_fitted(truth), recording.frames, recording.loads);
  ASSERT_TRUE(known && fitted);
  EXPECT_FALSE(fitted->report.circuit.empty());
  EXPECT_TRUE(fitted->model.provenance.contains("circuit"));
  const Recording test = record(truth, "multitouch", 2);
  const auto with_known = evaluate(known->model, test.frames, test.loads);
  const auto with_fitted = evaluate(fitted->model, test.frames, test.loads);
  ASSERT_TRUE(with_known && with_fitted);
  const ErrorSummary& best = with_known->estimators.front().relative_error;
  const ErrorSummary& reached = with_fitted->estimators.front().relative_error;
  EXPECT_LE(*reached.median, 1.1 * *best.median);
  EXPECT_LE(*reached.p95, 1.1 * *best.p95);
}

TEST(CircuitFit, sets_the_scale_and_says_so_where_no_resistance_is_known) {
  const ArrayDescription truth = uneven_array(6, 1);
  ArrayDescription unknown = to_be_fitted(truth);
  unknown.readout.load_ohm[0] = kFitOhm;
  const CircuitFit fit = fit_of(unknown, record(truth, "uniform", 1, leaky_rubber()));
  EXPECT_TRUE(says(fit, "only ratios"));
  double logarithm = 0.0;
  for (const double ohm : fit.array.readout.load_ohm) logarithm += std::log(ohm / 1000.0) / 6.0;
  EXPECT_NEAR(logarithm, 0.0, 1e-3);
  const double scale = fit.array.readout.load_ohm[2] / truth.readout.load_ohm[2];
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(fit.array.readout.drive_ohm[k] / truth.readout.drive_ohm[k] / scale, 1.0, 0.03) << k;
  }
}

TEST(CircuitFit, says_that_ideal_drivers_cannot_be_measured) {
  ArrayDescription truth = reference_array(6, 6);
  truth.readout.drive_ohm.assign(6, 0.0);
  ArrayDescription unknown = truth;
  unknown.readout.drive_ohm.assign(6, kFitOhm);
  const CircuitFit fit = fit_of(unknown, record(truth, "calibration", 1));
  EXPECT_TRUE(says(fit, "drive_ohm: too small")) << fit.statements.front();
  for (const double ohm : fit.array.readout.drive_ohm) EXPECT_LT(ohm, 5.0);
}

TEST(CircuitFit, refuses_an_array_that_is_never_pressed) {
  const ArrayDescription truth = reference_array(4, 4);
  const Recording idle = record(truth, "idle", 1, {}, 50);
  const auto fit = fit_circuit(to_be_fitted(truth), idle.frames, idle.loads);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("no frame presses"), std::string::npos) << fit.error().message;
}

TEST(CircuitFit, tells_the_circuits_apart) {
  struct Case {
    Circuit circuit;
    IdleColumns idle_columns;
  };
  for (const Case& c :
       {Case{Circuit::divider, IdleColumns::loaded}, Case{Circuit::divider, IdleColumns::floating},
        Case{Circuit::transimpedance, IdleColumns::loaded}, Case{Circuit::flexitac, IdleColumns::loaded}}) {
    ArrayDescription truth = reference_array(5, 5);
    truth.readout.circuit = c.circuit;
    truth.readout.idle_columns = c.idle_columns;
    SCOPED_TRACE(to_string(c.circuit));
    ArrayDescription unknown = reference_array(5, 5);
    unknown.readout.circuit = Circuit::automatic;
    unknown.readout.drive_ohm = {kFitOhm};
    unknown.readout.load_ohm = {200.0};
    const CircuitFit fit = fit_of(unknown, record(truth, "multitouch", 1, leaky_rubber(), 600));
    EXPECT_EQ(to_string(fit.array.readout.circuit), std::string(to_string(c.circuit)));
    EXPECT_EQ(fit.array.readout.idle_columns, c.idle_columns);
    EXPECT_TRUE(fit.candidates.front().chosen);
    EXPECT_LT(fit.candidates.front().held_out_error, 1.2);
    EXPECT_TRUE(says(fit, "held-out error"));
  }
}

TEST(CircuitFit, does_not_depend_on_the_number_of_threads) {
  const ArrayDescription truth = uneven_array(4, 1);
  const Recording recording = record(truth, "uniform", 1);
  const CircuitFit first = fit_of(to_be_fitted(truth), recording);
  std::vector<CircuitFit> nested(2);
  parallel_for(2, [&](std::size_t k) { nested[k] = fit_of(to_be_fitted(truth), recording); });
  for (const CircuitFit& other : nested) {
    EXPECT_EQ(first.array.readout.drive_ohm, other.array.readout.drive_ohm);
    EXPECT_EQ(first.array.readout.load_ohm, other.array.readout.load_ohm);
  }
}

}  // namespace
}  // namespace dermis::calibration
