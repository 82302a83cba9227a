// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/table_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/press_bench.hpp"
#include "learn/calibration/simulated.hpp"
#include "learn/calibration/tables/level_table.hpp"
#include "learn/calibration/tables/monotone_knots.hpp"

namespace dermis::learn::calibration {
namespace {

/// Bends more often than the units of a network.
double wavy(double newtons) {
  return 1e-4 * newtons * (1.0 + 0.11 * std::sin(8.0 * std::log(newtons)));
}
double smooth(double newtons) {
  return 1e-4 * std::pow(newtons, 0.9);
}

/// Mean relative error of the forces of new presses on the taxels from `first` to `last`.
double error_of(const touch::fusion::ForceNetworks& networks, const PressBench& bench, std::size_t first,
                std::size_t last, const std::vector<double>& forces) {
  BenchForces estimates(networks, bench);
  double sum = 0.0;
  double count = 0.0;
  for (const double newtons : forces) {
    for (std::size_t taxel = first; taxel < last; ++taxel) {
      sum += std::abs(static_cast<double>(estimates.press(taxel, newtons).newtons[taxel]) / newtons - 1.0);
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(TableChoice, takes_tables_where_networks_cannot_follow_the_rubber_and_leaves_them_elsewhere) {
  constexpr std::size_t kTaxels = 32;
  PressBench bench{kTaxels, [](std::size_t taxel, double n) { return taxel < kTaxels / 2 ? wavy(n) : smooth(n); }};
  const SampleDatabase database = bench.presses(forces_between(1.0, 50.0, 40), 2);
  const auto training = train_force_networks(database);
  ASSERT_TRUE(training) << training.error().message;
  const TrainingReport& report = training->report;
  std::vector<std::size_t> first_half(kTaxels / 2);
  std::iota(first_half.begin(), first_half.end(), 0U);
  EXPECT_EQ(report.table_taxels, first_half);
  EXPECT_EQ(report.groups, kTaxels);
  EXPECT_EQ(report.groups_on_tables, kTaxels / 2);
  EXPECT_NE(report.choice.find("16 of 32 groups of taxels (16 taxels): look-up table"), std::string::npos)
      << report.choice;
  ASSERT_TRUE(training->networks.is_consistent());
  EXPECT_EQ(training->networks.tables.taxels.size(), kTaxels / 2);

  const std::vector<double> new_forces = forces_between(1.0, 50.0, 200);
  touch::fusion::ForceNetworks without = training->networks;
  without.tables = {};
  const double of_tables = error_of(training->networks, bench, 0, kTaxels / 2, new_forces);
  EXPECT_LT(of_tables, 0.02);
  EXPECT_GT(error_of(without, bench, 0, kTaxels / 2, new_forces), 2.0 * of_tables);
  EXPECT_EQ(error_of(without, bench, kTaxels / 2, kTaxels, new_forces),
            error_of(training->networks, bench, kTaxels / 2, kTaxels, new_forces));
}

/// Hardly conducts until it is pressed hard: a network follows it, and makes newtons of the noise about zero.
TEST(TableChoice, takes_tables_where_networks_see_ghosts_after_a_press) {
  const auto law = [](std::size_t, double n) { return 2e-10 * std::pow(n, 4); };
  PressBench bench{12, law, 0.02};
  SampleDatabase database = bench.presses(forces_between(5.0, 50.0, 15), 2);
  for (int k = 0; k < 100; ++k) {
    database.samples.push_back(bench.sample(0, 0.0));
    database.samples.back().frame = database.samples.size() - 1;
  }
  const auto training = train_force_networks(database);
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.table_taxels.size(), 12U);
  touch::fusion::ForceNetworks without = training->networks;
  without.tables = {};
  BenchForces of_networks(without, bench);
  BenchForces of_tables(training->networks, bench);
  float ghost_of_networks = 0.0F;
  float ghost_of_tables = 0.0F;
  for (int k = 0; k < 100; ++k) {
    ghost_of_networks = std::max(ghost_of_networks, of_networks.press(0, 0.0).newtons[0]);
    ghost_of_tables = std::max(ghost_of_tables, of_tables.press(0, 0.0).newtons[0]);
  }
  EXPECT_GT(ghost_of_networks, 1.0F);
  EXPECT_LT(ghost_of_tables, 0.5F * ghost_of_networks);

  // Frames of before the first press tell nothing of a release.
  std::erase_if(database.samples, [&](const Sample& sample) { return sample.unloaded && sample.frame >= 20; });
  const auto unwatched = train_force_networks(database);
  ASSERT_TRUE(unwatched);
  EXPECT_TRUE(unwatched->report.table_taxels.empty());
}

/// The material remembers, and neither method knows of it.
TEST(TableChoice, two_weights_on_material_that_remembers_give_forces_no_worse_than_the_table) {
  simulation::SimulationOptions physics;
  physics.rubber.memory.emplace();
  for (const std::uint64_t seed : {1U, 2U}) {
    for (const std::size_t rows : {3U, 4U}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << rows << " rows");
      physics.rubber.seed = seed;
      const ArrayDescription array = reference_array(rows, 3);
      physics.scene = {.rate_hz = 10.0, .taxels = 3 * rows};
      const Recording weights = record(array, "two_weights", seed, physics);
      const auto database = build_sample_database(array, weights.frames, weights.loads);
      ASSERT_TRUE(database);
      const auto calibration = calibrate(*database);
      ASSERT_TRUE(calibration) << calibration.error().message;
      physics.scene = {.rate_hz = 25.0};
      const Recording touches = record(array, "touches", seed + 10, physics, 1500);
      const auto evaluation = evaluate(calibration->model, touches.frames, touches.loads);
      ASSERT_TRUE(evaluation);
      const EstimatorResult& dermis = evaluation->estimators.front();
      const EstimatorResult& table = evaluation->estimators[3];
      ASSERT_EQ(table.name, "crosstalk_lookup");
      EXPECT_LE(*dermis.relative_error.median, *table.relative_error.median);
      EXPECT_LE(*dermis.relative_error.p95, *table.relative_error.p95);
      EXPECT_LE(*dermis.ghost_n.p99, *table.ghost_n.p99);
    }
  }
}

TEST(TableChoice, tables_have_an_honest_sigma) {
  PressBench bench{16, [](std::size_t, double n) { return wavy(n); }, 0.02};
  const SampleDatabase database = bench.presses(forces_between(1.0, 50.0, 40), 3);
  const auto calibration = calibrate(database);
  ASSERT_TRUE(calibration) << calibration.error().message;
  ASSERT_EQ(calibration->report.training.table_taxels.size(), 16U);
  ASSERT_TRUE(calibration->report.uncertainty.relative_sigma_of_tables);
  BenchForces estimates(calibration->model.networks, bench);
  double within = 0.0;
  double count = 0.0;
  for (const double newtons : forces_between(1.0, 49.0, 100)) {
    for (std::size_t taxel = 0; taxel < 16; ++taxel) {
      const ForceFrame& force = estimates.press(taxel, newtons);
      within += std::abs(static_cast<double>(force.newtons[taxel]) - newtons) <= force.sigma_newtons[taxel] ? 1.0 : 0.0;
      count += 1.0;
    }
  }
  EXPECT_GT(within / count, 0.6);
  EXPECT_LE(within / count, 0.76);
}

/// As above, under rubbers whose exponents differ.
TEST(TableChoice, tables_have_an_honest_sigma_below_their_lightest_load) {
  constexpr std::size_t kTaxels = 32;
  const auto law = [](std::size_t taxel, double n) {
    return 1e-4 * std::pow(wavy(n) / 1e-4, 0.7 + 0.02 * static_cast<double>(taxel));
  };
  PressBench bench{kTaxels, law, 0.01};
  const auto calibration = calibrate(bench.presses(forces_between(1.0, 50.0, 40), 3));
  ASSERT_TRUE(calibration) << calibration.error().message;
  ASSERT_GT(calibration->report.training.table_taxels.size(), kTaxels / 2);
  BenchForces estimates(calibration->model.networks, bench);
  for (const double newtons : {0.25, 0.5}) {
    double within = 0.0;
    for (const std::size_t taxel : calibration->report.training.table_taxels) {
      const ForceFrame& force = estimates.press(taxel, newtons);
      const double error = std::abs(static_cast<double>(force.newtons[taxel]) - newtons);
      within += error <= 1.96 * force.sigma_newtons[taxel] ? 1.0 : 0.0;
    }
    EXPECT_GE(within / static_cast<double>(calibration->report.training.table_taxels.size()), 0.9) << newtons << " N";
  }
}

TEST(TableChoice, does_not_flip_on_noise) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    for (const double pink_noise : {1e-9, 1e-5}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", noise " << pink_noise);
      simulation::SimulationOptions physics;
      physics.rubber.seed = seed;
      physics.rubber.pink_noise = pink_noise;
      physics.rubber.contact_ohm = 100.0 * static_cast<double>(seed);
      const ArrayDescription array = reference_array(6, 6);
      const Recording recording = record(array, "calibration", seed, physics);
      const auto database = build_sample_database(array, recording.frames, recording.loads);
      ASSERT_TRUE(database);
      const auto training = train_force_networks(*database);
      ASSERT_TRUE(training);
      EXPECT_GT(training->report.groups, 0U);
      EXPECT_TRUE(training->report.table_taxels.empty());
      EXPECT_EQ(training->report.choice.find("table"), std::string::npos);
    }
  }
}

/// The unloaded frames at 25 C of the scene `uniform`, and one frame of one of its pressures there.
Recording one_uniform_load(const ArrayDescription& array, std::size_t pressure) {
  const Recording all = record(array, "uniform", 1);
  constexpr std::size_t kFirst = 180;  // of 25 C
  constexpr std::size_t kUnloaded = 20;
  Recording one;
  for (std::size_t k = 0; k <= kUnloaded; ++k) {
    const std::size_t frame = k < kUnloaded ? kFirst + k : kFirst + kUnloaded + 5 * pressure;
    for (Load load : all.loads) {
      if (load.frame != frame) continue;
      load.frame = k;
      one.loads.push_back(load);
    }
    one.frames.push_back(all.frames[frame]);
  }
  return one;
}

TEST(TableChoice, one_uniform_load_is_already_useful_and_says_what_it_is_worth) {
  const ArrayDescription array = reference_array(8, 8);
  const Recording one = one_uniform_load(array, 9);
  const double load = one.loads.back().value * *array.taxel_area_m2;
  const auto calibration = calibrate(array, one.frames, one.loads);
  ASSERT_TRUE(calibration) << calibration.error().message;
  const TrainingReport& report = calibration->report.training;
  EXPECT_TRUE(report.is_one_load);
  EXPECT_EQ(report.table_taxels.size(), 64U);
  EXPECT_NE(report.choice.find("straight line"), std::string::npos) << report.choice;

  const Recording touches = record(array, "multitouch", 2, {}, 300);
  const auto evaluation = evaluate(calibration->model, touches.frames, touches.loads);
  ASSERT_TRUE(evaluation);
  EXPECT_NEAR(evaluation->judged_from_n, load / 50.0, 1e-6);
  EXPECT_LT(*evaluation->estimators.front().relative_error.median, 0.2);  // from a fiftieth to six times that load
  EXPECT_GT(*evaluation->coverage.share_95, 0.9);
}

TEST(TableChoice, presses_of_one_weight_teach_the_other_taxels_a_line) {
  PressBench bench{12,
                   [](std::size_t taxel, double n) { return (1.0 + 0.02 * static_cast<double>(taxel)) * smooth(n); }};
  SampleDatabase database = bench.presses({10.0}, 2);
  std::erase_if(database.samples, [](const Sample& sample) { return sample.known_newtons[11] > 0.0F; });
  const auto training = train_force_networks(database);
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.table_taxels.size(), 11U);
  EXPECT_LT(error_of(training->networks, bench, 11, 12, forces_between(5.0, 10.0, 20)), 0.25);
}

/// `frames` of every weight in a row, taxel after taxel.
SampleDatabase held_presses(PressBench& bench, const std::vector<std::pair<double, int>>& frames_under) {
  SampleDatabase database = bench.presses({}, 0);
  for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
    for (const auto& [newtons, frames] : frames_under) {
      for (int k = 0; k < frames; ++k) {
        database.samples.push_back(bench.sample(taxel, newtons));
        database.samples.back().frame = database.samples.size() - 1;
      }
    }
  }
  return database;
}

TEST(TableChoice, many_frames_of_a_press_do_not_speak_against_the_network_that_saw_few_of_them) {
  PressBench bench{12, [](std::size_t, double n) { return 1e-4 * n; }, 0.02};
  const auto training = train_force_networks(held_presses(bench, {{5.0, 50}, {20.0, 50}}));
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.shared_networks, 12U);
  EXPECT_GT(training->report.groups, 0U);
  EXPECT_TRUE(training->report.table_taxels.empty()) << training->report.choice;
}

/// 15 presses of each taxel, of more samples than are kept: 60 presses are two groups.
TEST(TableChoice, a_press_is_one_though_samples_of_it_are_left_out) {
  PressBench bench{4, [](std::size_t, double n) { return smooth(n); }, 0.02};
  std::vector<std::pair<double, int>> frames_under;
  for (const double newtons : forces_between(1.0, 50.0, 15)) frames_under.emplace_back(newtons, 300);
  const auto training = train_force_networks(held_presses(bench, frames_under));
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.own_networks, 4U);
  EXPECT_EQ(training->report.groups, 2U);
}

/// Their means, of equal numbers, differ by what adding them up rounds off.
TEST(TableChoice, levels_that_read_the_same_give_a_table_that_can_be_written) {
  constexpr std::size_t kTaxels = 64;
  const PressBench bench{kTaxels, [](std::size_t taxel, double) { return 1e-4 + 1e-6 * static_cast<double>(taxel); },
                         0.0};
  PressBench presses = bench;
  SampleDatabase database = held_presses(presses, {{10.0, 10}, {12.0, 20}, {14.0, 30}});
  for (Sample& sample : database.samples) {
    if (sample.unloaded) continue;
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      sample.siemens[taxel] =
          static_cast<float>(kUnloadedSiemens + (sample.known_newtons[taxel] > 0.0F ? bench.law(taxel, 0.0) : 0.0));
    }
  }
  const auto training = train_force_networks(database);
  ASSERT_TRUE(training) << training.error().message;
  ASSERT_FALSE(training->networks.tables.taxels.empty());
  EXPECT_TRUE(training->networks.is_consistent());
}

TEST(LevelTable, a_linear_temperature_term_ends_before_it_turns_the_signal_round) {
  const std::vector<Knot> knots = level_table({{1.0, 1e-4, -50.0}, {2.0, 2e-4, 0.0}}, 0.05);
  ASSERT_EQ(knots.size(), 2U);
  EXPECT_GT(knots.front().y, 0.0);
}

TEST(MonotoneKnots, that_single_precision_cannot_tell_apart_are_one) {
  std::vector<Knot> knots = {{1.0, 1.0, 1.0}, {2.0, 2.0, 1.0}, {4.0, 2.0 + 1e-12, 3.0}, {4.0 + 1e-12, 5.0, 1.0}};
  pool_equal_floats(knots);
  ASSERT_EQ(knots.size(), 3U);
  EXPECT_NEAR(knots[1].x, 3.5, 1e-9);
  EXPECT_EQ(knots[1].weight, 4.0);
  EXPECT_EQ(knots[2].y, 5.0);
}

}  // namespace
}  // namespace dermis::learn::calibration
