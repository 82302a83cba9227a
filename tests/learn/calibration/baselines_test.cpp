// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/tables/baselines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::learn::calibration {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A database of one row of taxels whose signal is linear in force: reading = 0.1 + 0.05 F (1 + 0.01 dT).
SampleDatabase linear_database(std::size_t taxels) {
  SampleDatabase database;
  database.array.rows = 1;
  database.array.cols = taxels;
  database.array.readout.adc_bits = 10;
  return database;
}

Sample unloaded_sample(std::size_t taxels, double temperature) {
  Sample sample;
  sample.temperature_celsius = temperature;
  sample.ratio.assign(taxels, 0.1F);
  sample.sigma_ratio = 1.0 / 1023.0;
  sample.siemens.assign(taxels, 1e-3F);
  sample.taxels.assign(taxels, TaxelStatus::ok);
  sample.known_newtons.assign(taxels, 0.0F);
  sample.unloaded = true;
  return sample;
}

Sample pressed_sample(std::size_t taxels, std::size_t taxel, double newtons, double temperature) {
  Sample sample = unloaded_sample(taxels, temperature);
  sample.unloaded = false;
  sample.ratio[taxel] += static_cast<float>(0.05 * newtons * (1.0 + 0.01 * (temperature - 20.0)));
  sample.siemens[taxel] += static_cast<float>(1e-3 * newtons);
  sample.known_newtons[taxel] = static_cast<float>(newtons);
  return sample;
}

TEST(Baselines, are_the_three_of_the_documentation) {
  SampleDatabase database = linear_database(1);
  database.samples = {unloaded_sample(1, 20.0), pressed_sample(1, 0, 4.0, 20.0)};
  const auto tables = make_baselines(database);
  ASSERT_EQ(tables.size(), 3U);
  EXPECT_EQ(tables[0].name, "raw_lookup");
  EXPECT_EQ(tables[1].name, "temperature_lookup");
  EXPECT_EQ(tables[2].name, "crosstalk_lookup");
  EXPECT_EQ(tables[0].signal, touch::fusion::LookUpSignal::reading);
  EXPECT_EQ(tables[2].signal, touch::fusion::LookUpSignal::conductance);
  for (const auto& table : tables) EXPECT_TRUE(table.is_consistent());
}

TEST(Baselines, interpolate_between_the_calibrated_forces_of_each_taxel) {
  SampleDatabase database = linear_database(2);
  database.samples = {unloaded_sample(2, 20.0)};
  for (const double newtons : {1.0, 2.0, 5.0}) {
    for (std::size_t taxel = 0; taxel < 2; ++taxel) {
      database.samples.push_back(pressed_sample(2, taxel, newtons, 20.0));
    }
  }
  const auto tables = make_baselines(database);
  std::vector<float> newtons(2);
  tables[0].estimate(std::vector<double>{0.1 + 0.05 * 3.5, 0.1}, 20.0, newtons);
  EXPECT_NEAR(newtons[0], 3.5, 1e-5);
  EXPECT_NEAR(newtons[1], 0.0, 1e-9);
}

TEST(Baselines, take_a_linear_temperature_effect_out) {
  SampleDatabase database = linear_database(1);
  for (const double temperature : {10.0, 20.0, 30.0}) {
    database.samples.push_back(unloaded_sample(1, temperature));
    for (const double newtons : {1.0, 2.0, 4.0, 8.0}) {
      Sample sample = pressed_sample(1, 0, newtons, 20.0);
      sample.temperature_celsius = temperature;
      sample.ratio[0] *= static_cast<float>(1.0 + 0.005 * (temperature - 20.0));
      database.samples.push_back(sample);
    }
  }
  const auto tables = make_baselines(database);
  std::vector<float> raw(1);
  std::vector<float> corrected(1);
  const double reading = (0.1 + 0.05 * 4.0) * 1.05;
  tables[0].estimate(std::vector<double>{reading}, 30.0, raw);
  tables[1].estimate(std::vector<double>{reading}, 30.0, corrected);
  EXPECT_GT(std::abs(raw[0] - 4.0F), 0.2F);
  EXPECT_NEAR(corrected[0], 4.0, 0.03);
}

TEST(Baselines, rise_where_noise_makes_the_signal_fall) {
  SampleDatabase database = linear_database(1);
  database.samples = {unloaded_sample(1, 20.0), pressed_sample(1, 0, 1.0, 20.0), pressed_sample(1, 0, 2.0, 20.0),
                      pressed_sample(1, 0, 3.0, 20.0)};
  std::swap(database.samples[2].ratio, database.samples[3].ratio);
  for (const auto& table : make_baselines(database)) {
    std::vector<float> newtons(1);
    double last = -1.0;
    for (double signal = 0.0; signal < 0.4; signal += 0.001) {
      table.estimate(std::vector<double>{signal}, 20.0, newtons);
      EXPECT_GE(newtons[0], last);
      last = newtons[0];
    }
  }
}

TEST(Baselines, fit_one_slope_where_only_totals_are_known) {
  SampleDatabase database = linear_database(3);
  database.samples = {unloaded_sample(3, 20.0)};
  for (const double newtons : {2.0, 4.0, 9.0}) {
    Sample sample = unloaded_sample(3, 20.0);
    sample.unloaded = false;
    sample.ratio = {static_cast<float>(0.1 + 0.03 * newtons), static_cast<float>(0.1 + 0.02 * newtons), 0.1F};
    sample.known_newtons.assign(3, kUnknown);
    sample.totals = {{{0, 1, 2}, newtons}};
    database.samples.push_back(sample);
  }
  std::vector<float> newtons(3);
  make_baselines(database)[0].estimate(std::vector<double>{0.1 + 0.03 * 6.0, 0.1 + 0.02 * 6.0, 0.1}, 20.0, newtons);
  EXPECT_NEAR(newtons[0] + newtons[1] + newtons[2], 6.0, 1e-4);
  EXPECT_NEAR(newtons[0] / newtons[1], 1.5, 1e-4);
}

TEST(Baselines, keep_their_temperature_term_where_labels_scatter) {
  SampleDatabase database = linear_database(1);
  int k = 0;
  for (const double temperature : {10.0, 20.0, 30.0}) {
    database.samples.push_back(unloaded_sample(1, temperature));
    for (const double newtons : {1.0, 2.0, 4.0, 8.0}) {
      const double weighed = newtons * (1.0 + 0.002 * (k++ % 5 - 2));
      Sample sample = pressed_sample(1, 0, weighed, 20.0);
      sample.temperature_celsius = temperature;
      sample.ratio[0] *= static_cast<float>(1.0 + 0.005 * (temperature - 20.0));
      database.samples.push_back(sample);
    }
  }
  EXPECT_NEAR(make_baselines(database)[1].temperature_coefficient[0], -0.005, 0.0005);
}

TEST(Baselines, pass_over_a_saturated_reading_of_an_unloaded_frame) {
  SampleDatabase database = linear_database(1);
  database.samples = {unloaded_sample(1, 20.0), unloaded_sample(1, 20.0), pressed_sample(1, 0, 4.0, 20.0)};
  database.samples[1].known_newtons[0] = kUnknown;
  for (const auto& table : make_baselines(database)) EXPECT_TRUE(table.is_consistent());
}

}  // namespace
}  // namespace dermis::learn::calibration
