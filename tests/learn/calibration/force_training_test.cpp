// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/force_training.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/press_bench.hpp"
#include "learn/calibration/simulated.hpp"
#include "learn/calibration/simulated_user.hpp"

namespace dermis::learn::calibration {
namespace {

SampleDatabase database_of(const ArrayDescription& array, const Recording& recording) {
  auto database = build_sample_database(array, recording.frames, recording.loads);
  EXPECT_TRUE(database) << database.error().message;
  return std::move(*database);
}

/// Appends a recording, later in time.
void append(Recording& recording, const Recording& other) {
  const Nanos shift = recording.frames.back().time + std::chrono::seconds(1);
  const std::size_t first = recording.frames.size();
  for (RawFrame frame : other.frames) {
    frame.time += shift;
    recording.frames.push_back(frame);
  }
  for (Load load : other.loads) {
    load.frame += first;
    recording.loads.push_back(load);
  }
}

TEST(ForceTraining, gives_every_taxel_its_own_network_from_single_presses) {
  const ArrayDescription array = reference_array(3, 4);
  const auto training = train_force_networks(database_of(array, record(array, "calibration", 1)));
  ASSERT_TRUE(training) << training.error().message;
  const TrainingReport& report = training->report;
  EXPECT_EQ(report.own_networks, 12U);
  EXPECT_EQ(report.shared_networks, 0U);
  EXPECT_EQ(report.hidden_units, 4U);
  EXPECT_TRUE(report.uses_temperature);
  EXPECT_TRUE(report.dead_taxels.empty());
  EXPECT_NEAR(report.lightest_newtons, 0.5, 1e-6);
  EXPECT_NEAR(report.heaviest_newtons, 50.0, 1e-5);
  EXPECT_LT(report.median_fit_error, 0.02);
  EXPECT_TRUE(training->networks.is_consistent());
}

TEST(ForceTraining, follows_the_force_it_was_trained_on_and_rises_with_conductance) {
  const ArrayDescription array = reference_array(2, 2);
  const auto simulator = simulate(array, "calibration", 1);
  const auto training = train_force_networks(database_of(array, record(*simulator)));
  ASSERT_TRUE(training);
  touch::fusion::ForceFusion fusion(training->networks);
  ConductanceFrame conductance;
  conductance.taxels.assign(4, TaxelStatus::ok);
  conductance.sigma_siemens.assign(4, 1e-6);
  ForceFrame force;
  for (const double celsius : {2.0, 25.0, 48.0}) {
    conductance.temperature_celsius = celsius;
    std::vector<float> last(4, 0.0F);
    for (double newtons = 0.05; newtons < 49.0; newtons *= 1.02) {
      conductance.siemens.clear();
      for (std::size_t taxel = 0; taxel < 4; ++taxel) {
        conductance.siemens.push_back(simulator->rubber().conductance_from_force(taxel, newtons, celsius));
      }
      fusion.process(conductance, force);
      for (std::size_t taxel = 0; taxel < 4; ++taxel) {
        EXPECT_GT(force.newtons[taxel], last[taxel]);
        if (newtons >= 1.0) {
          EXPECT_NEAR(static_cast<double>(force.newtons[taxel]) / newtons, 1.0, 0.015) << newtons << " N";
        } else {
          EXPECT_NEAR(static_cast<double>(force.newtons[taxel]), newtons, 0.05 * newtons + 0.02);
        }
      }
      last = force.newtons;
    }
  }
}

TEST(ForceTraining, leaves_temperature_out_where_the_calibration_has_one) {
  const ArrayDescription array = reference_array(2, 2);
  Recording recording = record(array, "calibration", 1);
  for (RawFrame& frame : recording.frames) frame.temperature_celsius = 21.5;
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_FALSE(training->report.uses_temperature);
  EXPECT_EQ(training->networks.shape.inputs, 2U);
}

TEST(ForceTraining, shares_one_network_where_one_load_cell_weighs_the_whole_pad) {
  const ArrayDescription array = reference_array(4, 4);
  Recording recording = record(array, "multitouch", 5, {}, 300);
  std::vector<double> total(recording.frames.size());
  for (const Load& load : recording.loads) total[load.frame] += load.value;
  recording.loads.clear();
  for (std::size_t k = 0; k < total.size(); ++k) {
    recording.loads.push_back({k, LoadKind::force, all_taxels(array), total[k]});
  }
  append(recording, record(array, "idle", 6, {}, 30));

  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.shared_networks, 16U);
  EXPECT_EQ(training->report.own_networks, 0U);
  EXPECT_LT(training->report.shared_leave_one_out_error, 0.05);
  EXPECT_NE(training->report.choice.find("with a gain each"), std::string::npos) << training->report.choice;

  // The gains tell the taxels apart: compare with the true conductance of each at 10 N.
  const auto simulator = simulate(array, "idle", 1, {}, 1);
  touch::fusion::ForceFusion fusion(training->networks);
  ConductanceFrame conductance;
  conductance.temperature_celsius = 25.0;
  conductance.taxels.assign(16, TaxelStatus::ok);
  conductance.sigma_siemens.assign(16, 1e-6);
  for (std::size_t taxel = 0; taxel < 16; ++taxel) {
    conductance.siemens.push_back(simulator->rubber().conductance_from_force(taxel, 10.0, 25.0));
  }
  ForceFrame force;
  fusion.process(conductance, force);
  for (const float newtons : force.newtons) EXPECT_NEAR(newtons, 10.0F, 1.5F);
}

/// Each weight on each taxel, one frame a press.
Recording presses_of_weights(const ArrayDescription& array, const std::vector<double>& weights_n) {
  HandledArray handled(array, {}, 1);
  Recording recording;
  std::vector<double> force_n(array.taxel_count());
  const auto take = [&](const TaxelRegion& where, double newtons) {
    recording.loads.push_back({recording.frames.size(), LoadKind::force, where, newtons});
    recording.frames.push_back(handled.frame(force_n));
  };
  for (int frame = 0; frame < 20; ++frame) take(all_taxels(array), 0.0);
  for (const double newtons : weights_n) {
    for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
      force_n[taxel] = newtons;
      take({taxel / array.cols, taxel % array.cols, taxel / array.cols, taxel % array.cols}, newtons);
      force_n[taxel] = 0.0;
    }
  }
  return recording;
}

TEST(ForceTraining, learns_no_stair_from_two_weights) {
  const ArrayDescription array = reference_array(6, 6);
  const auto calibration = calibrate(database_of(array, presses_of_weights(array, {2.0, 20.0})));
  ASSERT_TRUE(calibration) << calibration.error().message;
  auto pipeline = touch::pipeline::Pipeline::create(calibration->model);
  ASSERT_TRUE(pipeline) << pipeline.error().message;
  HandledArray handled(array, {}, 2);
  std::vector<double> force_n(array.taxel_count());
  ForceFrame force;
  double sum = 0.0;
  for (std::size_t taxel = 0; taxel < force_n.size(); ++taxel) {
    force_n[taxel] = 6.0;
    pipeline->process(handled.frame(force_n), force);
    sum += std::abs(static_cast<double>(force.newtons[taxel]) / 6.0 - 1.0) / static_cast<double>(force_n.size());
    force_n[taxel] = 0.0;
  }
  EXPECT_LT(sum, 0.08);  // exponents and gains scatter; a stair is wrong by a third and more
}

/// Long holds whose readings creep: the scatter under one weight says nothing of the law between the weights.
SampleDatabase creeping_holds(PressBench& bench, const std::vector<double>& weights_n) {
  SampleDatabase database = bench.presses({}, 0);
  for (std::size_t taxel = 0; taxel < bench.taxels; ++taxel) {
    for (const double newtons : weights_n) {
      for (int k = 0; k < 200; ++k) {
        const double material = newtons * (1.0 + 0.1 * std::log10(0.1 * (k + 1)));
        database.samples.push_back(bench.sample(taxel, material));
        database.samples.back().known_newtons[taxel] = static_cast<float>(newtons);
        database.samples.back().frame = database.samples.size() - 1;
      }
    }
  }
  return database;
}

TEST(ForceTraining, takes_the_creep_of_few_weights_for_no_law) {
  for (const std::vector<double>& weights : {std::vector{5.0, 15.0}, std::vector{5.0, 10.0, 20.0}}) {
    SCOPED_TRACE(testing::Message() << weights.size() << " weights");
    PressBench bench{9, [](std::size_t, double newtons) { return 1e-4 * std::pow(newtons, 0.9); }, 0.002};
    const auto training = train_force_networks(creeping_holds(bench, weights));
    ASSERT_TRUE(training) << training.error().message;
    EXPECT_EQ(training->report.own_networks, weights.size() > 2 ? 9U : 0U);
    BenchForces estimates(training->networks, bench);
    for (const double newtons : {0.5, 2.0, 8.0, 30.0}) {
      EXPECT_NEAR(static_cast<double>(estimates.press(4, newtons).newtons[4]) / newtons, 1.0, 0.25) << newtons << " N";
    }
  }
}

TEST(ForceTraining, is_content_with_an_air_bladder) {
  const ArrayDescription array = reference_array(3, 3);
  const auto training = train_force_networks(database_of(array, record(array, "uniform", 2)));
  ASSERT_TRUE(training);
  EXPECT_EQ(training->report.own_networks, 9U);  // a uniform pressure tells the force of every taxel
  EXPECT_LT(training->report.median_fit_error, 0.03);
}

TEST(ForceTraining, mixes_own_and_shared_networks) {
  const ArrayDescription array = reference_array(3, 3);
  Recording recording = record(array, "calibration", 1);
  // Taxel r2c2 was pressed only with 5 N at most twice: not enough for a network of its own.
  std::size_t kept = 0;
  std::erase_if(recording.loads, [&](const Load& load) {
    return load.where == TaxelRegion{2, 2, 2, 2} && (load.value < 4.0 || load.value > 6.0 || ++kept > 2);
  });
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_EQ(training->report.own_networks, 8U);
  EXPECT_EQ(training->report.shared_networks, 1U);
}

TEST(ForceTraining, finds_a_dead_taxel) {
  const ArrayDescription array = reference_array(3, 3);
  Recording recording = record(array, "calibration", 1);
  for (RawFrame& frame : recording.frames) frame.counts[4] = 0.0F;
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_EQ(training->report.dead_taxels, (std::vector<std::size_t>{4}));
  EXPECT_EQ(training->networks.dead[4], 1);
  EXPECT_EQ(training->report.own_networks, 8U);
}

TEST(ForceTraining, needs_a_load_and_an_answer) {
  const ArrayDescription array = reference_array(2, 2);
  const Recording idle = record(array, "idle", 1, {}, 20);
  const auto unloaded = train_force_networks(database_of(array, idle));
  ASSERT_FALSE(unloaded);
  EXPECT_EQ(unloaded.error().message, "every load is zero: label frames with the force that presses on the array");

  Recording deaf = record(array, "calibration", 1);
  for (RawFrame& frame : deaf.frames) frame.counts.assign(4, 3.0F);
  const auto silent = train_force_networks(database_of(array, deaf));
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().message,
            "no taxel answers to its loads: check that frames and loads belong together, and the circuit");
}

TEST(ForceTraining, does_not_take_the_noise_of_a_temperature_sensor_for_temperature) {
  const ArrayDescription array = reference_array(3, 3);
  Recording recording = record(array, "calibration", 1);
  Random random(1);
  for (RawFrame& frame : recording.frames) frame.temperature_celsius = 25.0 + 0.4 * random.normal();
  recording.frames[100].temperature_celsius = 85.0;  // a glitch
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_FALSE(training->report.uses_temperature);
  EXPECT_EQ(training->report.own_networks, 9U);
}

TEST(ForceTraining, finds_a_taxel_that_is_stuck_at_the_end_of_the_adc) {
  ArrayDescription array = reference_array(3, 3);
  array.readout.circuit = Circuit::transimpedance;
  Recording recording = record(array, "calibration", 1);
  for (RawFrame& frame : recording.frames) frame.counts[4] = 4095.0F;
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training) << training.error().message;
  EXPECT_EQ(training->report.dead_taxels, (std::vector<std::size_t>{4}));
}

TEST(ForceTraining, gives_a_taxel_the_hidden_units_that_its_own_samples_hold) {
  const ArrayDescription array = reference_array(2, 2);
  Recording recording = record(array, "calibration", 1);
  std::size_t kept = 0;  // every eighth press of taxel 0: nine over all temperatures
  std::erase_if(recording.loads, [&](const Load& load) {
    return load.where == TaxelRegion{0, 0, 0, 0} && kept++ % 8 != 0;
  });
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_EQ(training->report.own_networks, 4U);
  EXPECT_EQ(training->report.hidden_units, 4U);  // the others are not held back
}

TEST(ForceTraining, needs_forces_that_differ_for_a_network_of_its_own) {
  const ArrayDescription array = reference_array(2, 2);
  Recording recording = record(array, "calibration", 1);
  Random random(3);
  std::erase_if(recording.loads,
                [](const Load& load) { return load.value > 0.0 && (load.value < 6.0 || load.value > 9.0); });
  for (Load& load : recording.loads) load.value *= 1.0 + 0.002 * random.normal();  // weighed, about one level
  const auto training = train_force_networks(database_of(array, recording));
  ASSERT_TRUE(training);
  EXPECT_EQ(training->report.own_networks, 0U);
}

}  // namespace
}  // namespace dermis::learn::calibration
