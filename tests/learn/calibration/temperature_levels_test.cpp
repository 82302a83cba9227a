// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/temperature_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dermis/learn/calibration/force_training.hpp"
#include "learn/calibration/press_bench.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr TemperatureSpan kSpan{40.0, 20.0};

/// 8 forces at each of the temperatures, rising with the force by as much as `drift` [inputs].
std::vector<WarmLoad> loads_at(const std::vector<double>& temperatures, double drift = 0.0) {
  std::vector<WarmLoad> loads;
  for (const double temperature : temperatures) {
    for (int k = 0; k < 8; ++k) loads.push_back({std::pow(2.0, k), temperature + drift * k / 7.0});
  }
  return loads;
}

TEST(TemperatureLevels, two_tell_a_line_and_three_a_law) {
  EXPECT_EQ(temperature_prior(loads_at({-1.0, 1.0}), kSpan), TemperaturePrior::line);
  EXPECT_EQ(temperature_prior(loads_at({-1.0, 0.0, 1.0}), kSpan), TemperaturePrior::free);
}

TEST(TemperatureLevels, are_no_more_where_temperature_goes_with_the_load) {
  EXPECT_EQ(temperature_prior(loads_at({0.0}, 1.0), kSpan), TemperaturePrior::line);
  EXPECT_EQ(temperature_prior(loads_at({-1.0, 0.5}, 0.5), kSpan), TemperaturePrior::line);
  EXPECT_EQ(temperature_prior(loads_at({-1.0, -0.3, 0.4}, 0.6), kSpan), TemperaturePrior::free);
}

TEST(TemperatureLevels, a_sensor_that_scatters_makes_none) {
  std::vector<WarmLoad> loads;
  Random random(3);
  for (int k = 0; k < 400; ++k) loads.push_back({5.0, (k % 2 == 0 ? -1.0 : 1.0) + 0.015 * random.normal()});
  EXPECT_EQ(temperature_prior(loads, kSpan), TemperaturePrior::line);
}

/// Presses of a rubber whose conductance changes by the factor exp(drift(T)).
SampleDatabase warm_presses(PressBench& bench, const std::vector<double>& celsius, double (*drift)(double)) {
  const auto law = bench.law;
  SampleDatabase all = bench.presses({}, 0);
  for (Sample& sample : all.samples) sample.temperature_celsius = celsius.front();
  for (const double base : celsius) {
    double warmth = 0.0;  // as people press: the heavier the later, the later the warmer
    for (const double newtons : forces_between(1.0, 30.0, 8)) {
      const double now = base + warmth;
      bench.law = [&](std::size_t taxel, double n) { return law(taxel, n) * std::exp(drift(now)); };
      for (int repeat = 0; repeat < 3; ++repeat) {
        for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
          all.samples.push_back(bench.sample(taxel, newtons));
          all.samples.back().temperature_celsius = now;
        }
      }
      warmth += 0.6;
    }
  }
  for (std::size_t k = 0; k < all.samples.size(); ++k) all.samples[k].frame = k;
  bench.law = law;
  return all;
}

ForceFrame press_at(const touch::fusion::ForceNetworks& networks, const PressBench& bench, double newtons,
                    double celsius, double (*drift)(double)) {
  ConductanceFrame conductance;
  for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
    conductance.siemens.push_back(kUnloadedSiemens + bench.law(taxel, newtons) * std::exp(drift(celsius)));
  }
  conductance.sigma_siemens.assign(bench.taxels, kNoiseSiemens);
  conductance.taxels.assign(bench.taxels, TaxelStatus::ok);
  conductance.temperature_celsius = celsius;
  ForceFrame force;
  touch::fusion::ForceFusion(networks).process(conductance, force);
  return force;
}

double line(double celsius) {
  return 0.02 * (celsius - 40.0);
}

double saturating(double celsius) {
  return celsius < 40.0 ? line(celsius) : 0.0;
}

TEST(TemperatureLevels, a_line_is_drawn_between_two_temperatures) {
  PressBench bench{4, [](std::size_t, double newtons) { return 1e-4 * std::pow(newtons, 0.9); }};
  const auto training = train_force_networks(warm_presses(bench, {27.0, 47.0}, line));
  ASSERT_TRUE(training) << training.error().message;
  for (const double celsius : {30.0, 35.0, 40.0, 45.0}) {
    for (const double newtons : {2.0, 8.0, 25.0}) {
      const ForceFrame force = press_at(training->networks, bench, newtons, celsius, line);
      for (const float estimate : force.newtons) {
        EXPECT_NEAR(static_cast<double>(estimate) / newtons, 1.0, 0.05) << newtons << " N at " << celsius << " C";
      }
    }
  }
}

TEST(TemperatureLevels, sigma_covers_what_happens_between_two_temperatures) {
  PressBench bench{4, [](std::size_t, double newtons) { return 1e-4 * std::pow(newtons, 0.9); }};
  const auto training = train_force_networks(warm_presses(bench, {27.0, 50.0}, saturating));
  ASSERT_TRUE(training) << training.error().message;
  const ForceFrame between = press_at(training->networks, bench, 8.0, 40.0, saturating);
  const ForceFrame beside = press_at(training->networks, bench, 8.0, 52.0, saturating);
  for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
    const double error = std::abs(static_cast<double>(between.newtons[taxel]) - 8.0);
    EXPECT_GT(error, 0.4);
    EXPECT_LT(error, 2.0 * static_cast<double>(between.sigma_newtons[taxel]));
    EXPECT_GT(between.sigma_newtons[taxel], 2.0F * beside.sigma_newtons[taxel]);
  }
}

TEST(TemperatureLevels, no_gap_is_left_by_three_even_temperatures) {
  PressBench bench{1, [](std::size_t, double newtons) { return 1e-4 * newtons; }};
  const auto gap = [&](const std::vector<double>& celsius) {
    const SampleDatabase database = warm_presses(bench, celsius, line);
    return temperature_gap(database, sample_temperatures(database));
  };
  const auto three = gap({20.0, 30.0, 40.0});
  EXPECT_EQ(three[0], three[1]);
  const auto two = gap({20.0, 40.0});
  EXPECT_NEAR(two[0], 24.2, 1e-9);
  EXPECT_NEAR(two[1], 40.0, 1e-9);
}

}  // namespace
}  // namespace dermis::learn::calibration
