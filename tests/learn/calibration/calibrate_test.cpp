// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The accuracy that the project promises (docs/accuracy.md), on the simulator and on recordings of others.
#include "dermis/learn/calibration/calibrate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/simulated.hpp"
#include "support/shared_data.hpp"

namespace dermis::learn::calibration {
namespace {

touch::pipeline::Model model_of(const ArrayDescription& array, const Recording& recording) {
  auto calibration = calibrate(array, recording.frames, recording.loads);
  EXPECT_TRUE(calibration) << calibration.error().message;
  return std::move(calibration->model);
}

EstimatorResult judge(const touch::pipeline::Model& model, const Recording& recording) {
  auto evaluation = evaluate(model, recording.frames, recording.loads);
  EXPECT_TRUE(evaluation) << evaluation.error().message;
  return evaluation->estimators.front();
}

/// Errors with the true law of the material behind the same crosstalk inversion: what no calibration can beat.
ErrorSummary judge_true_law(const ArrayDescription& array, simulation::Simulator& simulator) {
  touch::preprocessing::Conditioner conditioner(array);
  auto compensator = touch::compensation::Compensator::create(array);
  ConditionedFrame conditioned;
  ConductanceFrame conductance;
  RawFrame frame;
  std::vector<double> errors;
  while (simulator.next(frame).value()) {
    conditioner.process(frame, conditioned);
    compensator->process(conditioned, conductance);
    for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
      const double truth = simulator.truth().force_n[taxel];
      if (truth < 1.0) continue;
      const double newtons =
          simulator.rubber().force_from_conductance(taxel, conductance.siemens[taxel], *frame.temperature_celsius);
      errors.push_back(std::abs(newtons / truth - 1.0));
    }
  }
  return summarise(std::move(errors));
}

TEST(Calibrate, reaches_the_noise_floor_on_multitouch_from_single_presses) {
  const ArrayDescription array = reference_array(16, 16);
  const touch::pipeline::Model model = model_of(array, record(array, "calibration", 1));
  const EstimatorResult result = judge(model, record(array, "multitouch", 2));
  const ErrorSummary floor = judge_true_law(array, *simulate(array, "multitouch", 2));
  RecordProperty("true_law_median", std::to_string(*floor.median));
  RecordProperty("true_law_p95", std::to_string(*floor.p95));
  RecordProperty("true_law_p99", std::to_string(*floor.p99));
  EXPECT_LE(*result.relative_error.median, 0.007);
  EXPECT_LE(*result.relative_error.p95, 0.03);
  EXPECT_LE(*result.relative_error.p99, 0.05);
  EXPECT_LE(*result.ghost_n.p99, 0.1);
  EXPECT_LE(*result.relative_error.median, 1.1 * *floor.median);
  EXPECT_LE(*result.relative_error.p95, 1.1 * *floor.p95);
  EXPECT_LE(*result.relative_error.p99, 1.1 * *floor.p99);

  const EstimatorResult paper = judge(model, record(array, "paper", 3));
  EXPECT_EQ(paper.relative_error.count, 48U);
  EXPECT_LE(*paper.relative_error.max, 0.02);
}

TEST(Calibrate, serves_other_sizes_and_circuits) {
  struct Case {
    std::size_t rows, cols;
    double drive_ohm, load_ohm;
    Circuit circuit;
  };
  for (const Case& c : {Case{12, 10, 10.0, 470.0, Circuit::divider}, Case{8, 8, 30.0, 330.0, Circuit::divider},
                        Case{9, 7, 25.0, 150.0, Circuit::transimpedance}}) {
    ArrayDescription array = reference_array(c.rows, c.cols);
    array.readout.circuit = c.circuit;
    array.readout.drive_ohm.assign(c.rows, c.drive_ohm);
    array.readout.load_ohm.assign(c.cols, c.load_ohm);
    const touch::pipeline::Model model = model_of(array, record(array, "calibration", 1));
    const EstimatorResult result = judge(model, record(array, "multitouch", 2));
    EXPECT_LE(*result.relative_error.median, 0.007) << c.rows << "x" << c.cols;
    EXPECT_LE(*result.relative_error.p95, 0.03) << c.rows << "x" << c.cols;
    EXPECT_LE(*result.ghost_n.p99, 0.1) << c.rows << "x" << c.cols;
  }
}

TEST(Calibrate, learns_a_contact_resistance_and_a_temperature_curve) {
  const ArrayDescription array = reference_array(8, 8);
  simulation::SimulationOptions physics;
  physics.rubber.contact_ohm = 150.0;
  physics.rubber.temperature_curvature = 3e-5;
  const touch::pipeline::Model model = model_of(array, record(array, "calibration", 1, physics));
  const EstimatorResult result = judge(model, record(array, "multitouch", 2, physics));
  const ErrorSummary floor = judge_true_law(array, *simulate(array, "multitouch", 2, physics));
  EXPECT_LE(*result.relative_error.median, 1.1 * *floor.median);
  EXPECT_LE(*result.relative_error.p95, 1.1 * *floor.p95);
}

TEST(Calibrate, reports_hysteresis_and_creep_as_the_errors_they_are) {
  const ArrayDescription array = reference_array(8, 8);
  simulation::SimulationOptions physics;
  physics.rubber.hysteresis = 0.10;
  physics.rubber.creep = 0.05;
  const touch::pipeline::Model model = model_of(array, record(array, "calibration", 1, physics));
  const EstimatorResult result = judge(model, record(array, "multitouch", 2, physics));
  EXPECT_GT(*result.relative_error.p95, 0.03);  // compensated by a later version
  EXPECT_LT(*result.relative_error.median, 0.05);
}

TEST(Calibrate, does_not_depend_on_the_number_of_threads_or_on_chance) {
  const ArrayDescription array = reference_array(3, 3);
  const Recording recording = record(array, "calibration", 1);
  const touch::pipeline::Model first = model_of(array, recording);
  std::vector<touch::pipeline::Model> nested(2);
  parallel_for(2, [&](std::size_t k) { nested[k] = model_of(array, recording); });
  for (const touch::pipeline::Model& other : nested) {
    EXPECT_EQ(first.networks.parameters, other.networks.parameters);
    EXPECT_EQ(first.provenance, other.provenance);
  }
}

TEST(Calibrate, tells_where_the_time_goes_and_shows_progress) {
  const ArrayDescription array = reference_array(3, 3);
  const Recording recording = record(array, "calibration", 1);
  std::vector<std::string> stages;
  const auto calibration =
      calibrate(array, recording.frames, recording.loads, Nanos{0}, [&](const std::string& stage, double share) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        if (stages.empty() || stages.back() != stage) stages.push_back(stage);
      });
  ASSERT_TRUE(calibration);
  EXPECT_EQ(stages, (std::vector<std::string>{"circuit", "networks"}));
  ASSERT_EQ(calibration->report.stages.size(), 4U);
  EXPECT_EQ(calibration->report.stages[1].stage, "networks");
  EXPECT_EQ(calibration->report.stages[3].stage, "uncertainty");
  EXPECT_EQ(calibration->model.baselines.size(), 3U);
}

/// A press of ../shared/data/dsa_weights: its mean frame over the last five seconds, and the weight.
struct Press {
  RawFrame mean;
  double newtons = 0.0;
};

std::vector<Press> dsa_presses(const std::filesystem::path& folder) {
  std::vector<Press> presses;
  std::ifstream index(folder / "presses.csv");
  std::string line;
  std::getline(index, line);
  while (std::getline(index, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells.at(6) != "0") continue;  // outlier
    const auto frames = bytes::recordings::read_frames((folder / "presses" / (cells[0] + ".csv")).string(),
                                                       {.shape = FrameShape{13, 6}});
    EXPECT_TRUE(frames) << frames.error().message;
    Press press;
    press.newtons = std::stod(cells[2]) * 9.80665e-3;
    press.mean.counts.assign(78, 0.0F);
    press.mean.temperature_celsius = 0.0;
    float count = 0.0F;
    for (const RawFrame& frame : *frames) {
      if (frame.time < frames->back().time - std::chrono::seconds(5)) continue;
      count += 1.0F;
      for (std::size_t k = 0; k < 78; ++k) press.mean.counts[k] += frame.counts[k];
      *press.mean.temperature_celsius += *frame.temperature_celsius;
    }
    for (float& value : press.mean.counts) value /= count;
    *press.mean.temperature_celsius /= static_cast<double>(count);
    presses.push_back(press);
  }
  return presses;
}

TEST(Calibrate, weighs_the_real_presses_it_has_not_seen) {
  const std::filesystem::path folder = support::shared_data("dsa_weights");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << support::not_checked(folder);
  ArrayDescription array;
  array.rows = 13;
  array.cols = 6;
  array.readout.circuit = Circuit::none;
  const std::vector<Press> presses = dsa_presses(folder);
  ASSERT_EQ(presses.size(), 54U);
  double square = 0.0;
  for (std::size_t held_out = 0; held_out < presses.size(); ++held_out) {
    Recording recording;
    RawFrame unloaded;
    unloaded.counts.assign(78, 0.0F);
    unloaded.temperature_celsius = presses[(held_out + 1) % presses.size()].mean.temperature_celsius;
    recording.frames.push_back(unloaded);
    recording.loads.push_back({0, LoadKind::force, all_taxels(array), 0.0});
    for (std::size_t k = 0; k < presses.size(); ++k) {
      if (k == held_out) continue;
      recording.loads.push_back({recording.frames.size(), LoadKind::force, all_taxels(array), presses[k].newtons});
      recording.frames.push_back(presses[k].mean);
    }
    const touch::pipeline::Model model = model_of(array, recording);
    auto pipeline = touch::pipeline::Pipeline::create(model);
    ASSERT_TRUE(pipeline);
    ForceFrame force;
    pipeline->process(presses[held_out].mean, force);
    const double sum = std::accumulate(force.newtons.begin(), force.newtons.end(), 0.0);
    square += std::pow(sum - presses[held_out].newtons, 2);
  }
  constexpr double kPascalPerNewton = 9.07e3;  // over the contact area of 110 mm2
  const double rmse_kpa = 1e-3 * kPascalPerNewton * std::sqrt(square / static_cast<double>(presses.size()));
  RecordProperty("rmse_kpa", std::to_string(rmse_kpa));
  EXPECT_LE(rmse_kpa, 3.3);
}

}  // namespace
}  // namespace dermis::learn::calibration
