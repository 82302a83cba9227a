// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/press_bench.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

/// Unloaded samples of an array whose readings are taken as they are, `level` counts of 1023 with normal noise.
SampleDatabase unloaded_database(std::size_t samples, double level, double noise_counts, bool rounded,
                                 std::uint64_t seed) {
  Random random(seed);
  SampleDatabase database;
  database.array.rows = 6;
  database.array.cols = 6;
  database.array.readout.circuit = Circuit::none;
  database.array.readout.adc_bits = 10;
  for (std::size_t k = 0; k < samples; ++k) {
    Sample& sample = database.samples.emplace_back();
    const double supply = random.uniform(0.8, 1.2);  // of the reference: what a count is worth
    sample.unloaded = true;
    sample.sigma_ratio = database.array.readout.adc_noise_counts / (1023.0 * supply);
    sample.taxels.assign(36, TaxelStatus::ok);
    sample.known_newtons.assign(36, 0.0F);
    for (std::size_t taxel = 0; taxel < 36; ++taxel) {
      const double drift = 0.01 * static_cast<double>(k);
      double counts = level * supply + drift + noise_counts * random.normal();
      if (rounded) counts = std::clamp(std::round(counts), 0.0, 1023.0);
      sample.ratio.push_back(static_cast<float>(counts / 1023.0 / supply));
    }
  }
  return database;
}

TEST(Uncertainty, adc_noise_is_the_one_simulated_whatever_supply_and_drift_do) {
  for (const double noise : {0.5, 1.0, 3.0}) {
    const auto measured = measure_adc_noise(unloaded_database(60, 40.0, noise, true, 7));
    ASSERT_TRUE(measured);
    EXPECT_NEAR(*measured / std::sqrt(noise * noise + 1.0 / 12.0), 1.0, 0.05) << noise;
  }
  const auto averaged = measure_adc_noise(unloaded_database(60, 40.0, 0.6, false, 8));  // a source that averages
  ASSERT_TRUE(averaged);
  EXPECT_NEAR(*averaged, 0.6, 0.03);
}

TEST(Uncertainty, adc_noise_is_at_least_that_of_rounding) {
  const auto measured = measure_adc_noise(unloaded_database(60, 40.0, 0.0, false, 9));
  ASSERT_TRUE(measured);
  EXPECT_DOUBLE_EQ(*measured, 1.0 / std::sqrt(12.0));
}

TEST(Uncertainty, adc_noise_is_not_made_up_where_the_end_of_the_adc_hides_it) {
  EXPECT_FALSE(measure_adc_noise(unloaded_database(60, 0.5, 1.0, true, 10)));
  EXPECT_FALSE(measure_adc_noise(unloaded_database(4, 40.0, 1.0, true, 11)));  // too few
}

TEST(Uncertainty, adc_noise_is_found_where_the_end_of_the_adc_cuts_it) {
  for (const double noise : {5.0, 10.0}) {
    const auto measured = measure_adc_noise(unloaded_database(60, 2.0, noise, true, 14));
    ASSERT_TRUE(measured);
    EXPECT_NEAR(*measured / noise, 1.0, 0.1);
  }
}

TEST(Uncertainty, adc_noise_is_not_raised_by_a_touch_or_a_flickering_taxel) {
  SampleDatabase database = unloaded_database(60, 40.0, 1.0, true, 12);
  for (float& ratio : database.samples[20].ratio) ratio *= 3.0F;
  Random random(1);
  for (Sample& sample : database.samples) sample.ratio[5] += static_cast<float>(0.1 * random.normal());
  const auto measured = measure_adc_noise(database);
  ASSERT_TRUE(measured);
  EXPECT_NEAR(*measured / std::sqrt(13.0 / 12.0), 1.0, 0.06);
}

SampleDatabase temperatures(std::size_t count, double noise, double step) {
  Random random(3);
  SampleDatabase database;
  for (std::size_t k = 0; k < count; ++k) {
    const double celsius = 20.0 + 0.01 * static_cast<double>(k) + (k > count / 2 ? step : 0.0);
    database.samples.emplace_back().temperature_celsius = celsius + noise * random.normal();
  }
  return database;
}

TEST(Uncertainty, temperature_noise_is_that_of_the_sensor_not_of_the_room) {
  EXPECT_NEAR(measure_temperature_noise(temperatures(500, 0.3, 20.0)), 0.3, 0.04);
  EXPECT_EQ(measure_temperature_noise(temperatures(500, 12.0, 0.0)), 0.0);  // a new temperature every time
  EXPECT_EQ(measure_temperature_noise(temperatures(10, 0.3, 0.0)), 0.0);
}

/// Share of taxels within the 68 % and 95 % intervals in a multitouch scene after single presses.
Coverage coverage_of(const ArrayDescription& array, const simulation::SimulationOptions& physics,
                     UncertaintyReport* report = nullptr) {
  const Recording presses = record(array, "calibration", 1, physics);
  const auto calibration = calibrate(array, presses.frames, presses.loads);
  EXPECT_TRUE(calibration);
  if (report != nullptr) *report = calibration->report.uncertainty;
  const Recording touches = record(array, "multitouch", 2, physics, 300);
  const auto evaluation = evaluate(calibration->model, touches.frames, touches.loads);
  EXPECT_TRUE(evaluation);
  return evaluation->coverage;
}

void expect_calibrated(const Coverage& coverage) {
  EXPECT_GT(coverage.count, 2000U);
  EXPECT_GE(*coverage.share_68, 0.63);
  EXPECT_LE(*coverage.share_68, 0.73);
  EXPECT_GE(*coverage.share_95, 0.92);
  EXPECT_LE(*coverage.share_95, 0.98);
}

TEST(Uncertainty, intervals_cover_what_they_promise_with_a_divider) {
  UncertaintyReport report;
  expect_calibrated(coverage_of(reference_array(8, 8), {}, &report));
  EXPECT_NEAR(report.adc_noise_counts.value_or(0.0), std::sqrt(13.0 / 12.0), 0.06);
  EXPECT_NEAR(report.temperature_sigma_celsius, 0.3, 0.03);
  EXPECT_NEAR(report.supply_noise, 0.001, 0.0006);
}

TEST(Uncertainty, of_the_supply_is_found_where_all_taxels_are_on_tables) {
  const ArrayDescription array = reference_array(8, 8);
  const Recording recording = record(array, "calibration", 1);
  const auto database = build_sample_database(array, recording.frames, recording.loads);
  ASSERT_TRUE(database);
  auto training = train_force_networks(*database);
  ASSERT_TRUE(training);
  const auto supply_noise = [&] {
    touch::pipeline::Model model;
    model.array = array;
    model.networks = training->networks;
    const auto report = fit_uncertainty(*database, *training, model);
    EXPECT_TRUE(report);
    return report->supply_noise;
  };
  const double by_networks = supply_noise();
  EXPECT_GT(by_networks, 0.0);
  training->tested_tables = std::exchange(training->tested_own, {});
  EXPECT_EQ(supply_noise(), by_networks);
}

TEST(Uncertainty, intervals_cover_what_they_promise_where_the_material_is_noisy) {
  simulation::SimulationOptions physics;
  physics.rubber.pink_noise = 1e-6;
  physics.environment.adc_noise_lsb = 2.0;
  expect_calibrated(coverage_of(reference_array(8, 8), physics));
}

TEST(Uncertainty, intervals_cover_what_they_promise_at_virtual_ground) {
  ArrayDescription array = reference_array(8, 8);
  array.readout.circuit = Circuit::transimpedance;
  array.readout.drive_ohm.assign(8, 25.0);
  array.readout.load_ohm.assign(8, 150.0);
  expect_calibrated(coverage_of(array, {}));
}

/// Presses on every eighth taxel, or on all others.
std::vector<Load> some_presses(const ArrayDescription& array, const std::vector<Load>& loads, bool every_eighth) {
  std::vector<Load> some;
  std::copy_if(loads.begin(), loads.end(), std::back_inserter(some), [&](const Load& load) {
    const std::size_t taxel = array.index(load.where.first_row, load.where.first_col);
    return load.value == 0.0 || (taxel % 8 == 3) == every_eighth;
  });
  return some;
}

TEST(Uncertainty, intervals_cover_what_they_promise_on_taxels_that_were_never_pressed) {
  const ArrayDescription array = reference_array(12, 10);
  constexpr std::size_t kPieces = 8;  // the scatter of 15 taxels tells that of the piece to a fifth
  double count = 0.0;
  double within_68 = 0.0;
  double within_95 = 0.0;
  for (std::size_t piece = 1; piece <= kPieces; ++piece) {
    simulation::SimulationOptions physics;
    physics.rubber.seed = piece;
    const Recording presses = record(array, "paper_calibration", 1, physics);
    const auto calibration = calibrate(array, presses.frames, some_presses(array, presses.loads, true));
    ASSERT_TRUE(calibration) << calibration.error().message;
    EXPECT_TRUE(calibration->report.uncertainty.relative_sigma_of_unpressed);
    const Recording others = record(array, "paper_calibration", 2, physics);
    const auto evaluation = evaluate(calibration->model, others.frames, some_presses(array, others.loads, false));
    ASSERT_TRUE(evaluation) << evaluation.error().message;
    const auto judged = static_cast<double>(evaluation->coverage.count);
    count += judged;
    within_68 += judged * *evaluation->coverage.share_68;
    within_95 += judged * *evaluation->coverage.share_95;
  }
  EXPECT_GE(within_68 / count, 0.63);
  EXPECT_LE(within_68 / count, 0.73);
  EXPECT_GE(within_95 / count, 0.92);
  EXPECT_LE(within_95 / count, 0.98);
}

struct Covered {
  double count = 0.0;
  double within_68 = 0.0;
  double within_95 = 0.0;

  void judge(float newtons, float sigma, double true_newtons) {
    const double error = std::abs(static_cast<double>(newtons) - true_newtons) / static_cast<double>(sigma);
    count += 1.0;
    within_68 += error <= 1.0 ? 1.0 : 0.0;
    within_95 += error <= 1.96 ? 1.0 : 0.0;
  }
};

// Rubber that answers each touch with another gain: what a touch shows of one weight and of the next is one error.
TEST(Uncertainty, loads_of_one_touch_count_as_one) {
  constexpr double kGainDeviation = 0.05;
  Random chance(5);
  double gain = 1.0;
  PressBench bench{24, [&](std::size_t, double newtons) { return gain * 1e-4 * std::pow(newtons, 0.9); }, 0.002};
  SampleDatabase database = bench.presses({}, 0);
  for (int touch = 0; touch < 2; ++touch) {
    for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
      gain = std::exp(kGainDeviation * chance.normal());
      for (const double newtons : {5.0, 15.0, 5.0}) {
        for (int k = 0; k < 30; ++k) database.samples.push_back(bench.sample(taxel, newtons));
      }
      database.samples.push_back(bench.sample(taxel, 0.0));
    }
  }
  for (std::size_t k = 0; k < database.samples.size(); ++k) database.samples[k].frame = k;
  const auto calibration = calibrate(database);
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_LT(calibration->report.uncertainty.supply_noise, 0.005);  // 0 is true
  BenchForces estimates(calibration->model.networks, bench);
  Covered covered;
  for (int repeat = 0; repeat < 20; ++repeat) {
    for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
      gain = std::exp(kGainDeviation * chance.normal());
      const double newtons = std::array{6.0, 9.0, 13.0}[static_cast<std::size_t>(repeat) % 3];
      const ForceFrame& force = estimates.press(taxel, newtons);
      covered.judge(force.newtons[taxel], force.sigma_newtons[taxel], newtons);
    }
  }
  EXPECT_GE(covered.within_68 / covered.count, 0.6);
  EXPECT_LE(covered.within_68 / covered.count, 0.8);
  EXPECT_GE(covered.within_95 / covered.count, 0.9);
}

TEST(Uncertainty, a_handful_of_presses_does_not_tell_more_than_is_known_of_sheets) {
  Covered covered;
  for (std::uint64_t sheet = 1; sheet <= 12; ++sheet) {
    Random chance(sheet);
    std::vector<double> gain(30);
    for (double& of_taxel : gain) of_taxel = std::exp(0.15 * chance.normal());
    const auto law = [&](std::size_t taxel, double newtons) { return gain[taxel] * 1e-4 * std::pow(newtons, 0.9); };
    PressBench bench{gain.size(), law, 0.002};
    SampleDatabase database = bench.presses({}, 0);
    const std::array weights{2.0, 3.0, 5.0, 8.0, 12.0};
    for (std::size_t k = 0; k < weights.size(); ++k) database.samples.push_back(bench.sample(k, weights[k]));
    for (std::size_t k = 0; k < database.samples.size(); ++k) database.samples[k].frame = k;
    const auto calibration = calibrate(database);
    ASSERT_TRUE(calibration) << calibration.error().message;
    ASSERT_FALSE(calibration->report.remarks.empty());
    EXPECT_NE(calibration->report.remarks.front().find("25 of 30 taxels were not pressed"), std::string::npos);
    BenchForces estimates(calibration->model.networks, bench);
    for (std::size_t taxel = weights.size(); taxel < bench.taxels; ++taxel) {
      const ForceFrame& force = estimates.press(taxel, 5.0);
      covered.judge(force.newtons[taxel], force.sigma_newtons[taxel], 5.0);
    }
  }
  EXPECT_GE(covered.within_68 / covered.count, 0.6);
  EXPECT_LE(covered.within_68 / covered.count, 0.85);
  EXPECT_GE(covered.within_95 / covered.count, 0.9);
}

TEST(Uncertainty, loads_that_differ_by_little_do_not_tell_the_exponent) {
  constexpr double kWeighing = 0.03;
  Random chance(9);
  std::vector<double> gain(48);
  for (double& of_taxel : gain) of_taxel = std::exp(0.15 * chance.normal());
  const auto law = [&](std::size_t taxel, double newtons) { return gain[taxel] * 1e-4 * std::pow(newtons, 0.9); };
  PressBench bench{gain.size(), law, 0.002};
  SampleDatabase database = bench.presses({}, 0);
  for (int press = 0; press < 3; ++press) {
    for (std::size_t taxel = 0; taxel < 24; ++taxel) {
      database.samples.push_back(bench.sample(taxel, 6.0 * std::exp(kWeighing * chance.normal())));
    }
  }
  for (std::size_t k = 0; k < database.samples.size(); ++k) database.samples[k].frame = k;
  const auto calibration = calibrate(database);
  ASSERT_TRUE(calibration) << calibration.error().message;
  BenchForces estimates(calibration->model.networks, bench);
  const ForceFrame light = estimates.press(40, 0.5);
  const float share_of_light = light.sigma_newtons[40] / light.newtons[40];
  const ForceFrame heavy = estimates.press(40, 6.0);
  const float share_of_heavy = heavy.sigma_newtons[40] / heavy.newtons[40];
  EXPECT_GT(share_of_light, 2.0F * share_of_heavy);
  EXPECT_LT(share_of_heavy, 0.25F);
}

// A bladder loads all taxels, and the inversion makes much noise of such readings; a contact's are less noisy.
TEST(Uncertainty, keeps_what_the_noise_of_the_samples_has_left_in_the_networks) {
  const ArrayDescription array = reference_array(32, 32);
  const Recording uniform = record(array, "uniform", 1);
  const auto calibration = calibrate(array, uniform.frames, uniform.loads);
  ASSERT_TRUE(calibration) << calibration.error().message;
  const Recording contacts = record(array, "multitouch", 2, {}, 100);
  const auto evaluation = evaluate(calibration->model, contacts.frames, contacts.loads);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  EXPECT_GT(*evaluation->coverage.share_68, 0.63);
  EXPECT_GT(*evaluation->coverage.share_95, 0.92);
  const auto& estimators = evaluation->estimators;
  const auto lookup = std::find_if(estimators.begin(), estimators.end(),
                                   [](const auto& estimator) { return estimator.name == "crosstalk_lookup"; });
  ASSERT_NE(lookup, estimators.end());
  EXPECT_LE(*estimators.front().relative_error.median, *lookup->relative_error.median);
}

constexpr double kLightest = 0.5;
constexpr double kHeaviest = 10.0;

/// A rubber that is not the estimator's: with a resistance in series, logarithmic, stiffening, or a power law. Its
/// excess conductance is about 1 mS at the heaviest load.
std::function<double(double newtons)> draw_law(Random& random) {
  const double exponent = random.uniform(0.6, 1.3);
  const double in_series = random.uniform(0.0, 0.4);  // of the resistance at the heaviest load
  const double bend = random.uniform(2.0, 30.0);      // heaviest load over the force where the logarithm bends
  const double stiffening = random.uniform(-0.05, 0.05);
  switch (random.below(4)) {
    case 0:
      return [=](double n) { return 1e-3 / (in_series + (1.0 - in_series) * std::pow(n / kHeaviest, -exponent)); };
    case 1: return [=](double n) { return 1e-3 * std::log1p(bend * n / kHeaviest) / std::log1p(bend); };
    case 2:
      return [=](double n) {
        const double x = std::log(n / kHeaviest);
        return 1e-3 * std::exp(exponent * x + stiffening * x * x);
      };
    default: return [=](double n) { return 1e-3 * std::pow(n / kHeaviest, exponent); };
  }
}

/// Share of the forces of rubbers of unknown laws that the 95 % intervals hold, a share of them at each of `forces`.
std::vector<double> shares_held(const std::vector<double>& forces) {
  constexpr std::size_t kRubbers = 150;
  constexpr std::size_t kTaxels = 4;
  std::vector<double> held(forces.size());
  for (std::size_t seed = 1; seed <= kRubbers; ++seed) {
    Random random(seed);
    std::vector<std::function<double(double)>> laws;
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) laws.push_back(draw_law(random));
    PressBench bench{kTaxels, [&](std::size_t taxel, double newtons) { return laws[taxel](newtons); }, 0.01,
                     Random(seed)};
    const auto calibration = calibrate(bench.presses(forces_between(kLightest, kHeaviest, 12), 3));
    EXPECT_TRUE(calibration);
    BenchForces estimates(calibration->model.networks, bench);
    for (std::size_t k = 0; k < forces.size(); ++k) {
      for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
        const ForceFrame& force = estimates.press(taxel, forces[k]);
        const double error = std::abs(static_cast<double>(force.newtons[taxel]) - forces[k]);
        EXPECT_TRUE(std::isfinite(force.sigma_newtons[taxel])) << "seed " << seed << ", " << forces[k] << " N";
        if (error <= 1.96 * force.sigma_newtons[taxel]) held[k] += 1.0 / static_cast<double>(kTaxels * kRubbers);
      }
    }
  }
  return held;
}

TEST(Uncertainty, intervals_hold_beyond_the_heaviest_and_below_the_lightest_load_whatever_the_law) {
  const std::vector<double> forces = {0.25 * kLightest, 0.5 * kLightest, 2.0 * kHeaviest, 4.0 * kHeaviest};
  const std::vector<double> held = shares_held(forces);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    EXPECT_GE(held[k], 0.90) << forces[k] << " N";
    EXPECT_LE(held[k], 0.99) << forces[k] << " N";
  }
}

/// Of the forces of sheets of one law, the share within two standard deviations, and the median of sigma over force.
std::pair<double, double> held_of_sheets(const std::function<double(double)>& law, double newtons) {
  constexpr std::size_t kSheets = 20;
  constexpr std::size_t kTaxels = 9;
  double held = 0.0;
  std::vector<double> sigmas;
  for (std::size_t seed = 1; seed <= kSheets; ++seed) {
    PressBench bench{kTaxels,
                     [&](std::size_t taxel, double n) { return (1.0 + 0.05 * static_cast<double>(taxel)) * law(n); },
                     0.01, Random(seed)};
    const auto calibration = calibrate(bench.presses(forces_between(kLightest, kHeaviest, 12), 3));
    EXPECT_TRUE(calibration);
    BenchForces estimates(calibration->model.networks, bench);
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      const ForceFrame& force = estimates.press(taxel, newtons);
      const double sigma = force.sigma_newtons[taxel];
      const double error = std::abs(static_cast<double>(force.newtons[taxel]) - newtons);
      if (error <= 2.0 * sigma) held += 1.0 / static_cast<double>(kTaxels * kSheets);
      sigmas.push_back(sigma / static_cast<double>(force.newtons[taxel]));
    }
  }
  return {held, upper_median(std::move(sigmas))};
}

TEST(Uncertainty, sigma_sees_a_law_that_flattens_and_one_with_a_knee) {
  const auto flattens = [](double n) { return 1e-3 / (1.0 + 1.0 / std::expm1(n / 6.0)); };
  const auto has_knee = [](double n) { return 1e-4 * std::max(n - 0.3 + 0.3 * std::exp(-n / 0.3), 0.0); };
  EXPECT_GE(held_of_sheets(flattens, 2.0 * kHeaviest).first, 0.7);  // noise of 1 % hides much of its end
  EXPECT_GE(held_of_sheets(has_knee, 0.3 * kLightest).first, 0.85);
}

TEST(Uncertainty, sigma_of_a_power_law_stays_narrow_at_its_ends) {
  const auto power = [](double n) { return 1e-4 * std::pow(n, 0.9); };
  EXPECT_LT(held_of_sheets(power, 2.0 * kHeaviest).second, 0.25);
  EXPECT_LT(held_of_sheets(power, 0.5 * kLightest).second, 0.12);
}

}  // namespace
}  // namespace dermis::learn::calibration
