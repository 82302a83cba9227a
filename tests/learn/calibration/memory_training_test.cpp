// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/memory/memory_training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

simulation::SimulationOptions rubber(double touch_gain) {
  simulation::SimulationOptions physics;
  physics.rubber.memory.emplace().touch_gain = touch_gain;
  return physics;
}

Recording two_weights(const ArrayDescription& array, simulation::SimulationOptions physics, std::uint64_t seed) {
  physics.scene = {.rate_hz = 20.0, .taxels = array.taxel_count()};
  return record(array, "two_weights", seed, physics);
}

Recording touches(const ArrayDescription& array, simulation::SimulationOptions physics, std::uint64_t seed) {
  physics.scene = {.rate_hz = 50.0};
  return record(array, "touches", seed, physics, 2000);
}

TEST(MemoryTraining, two_weights_teach_what_the_material_remembers) {
  const ArrayDescription array = reference_array(2, 3);
  for (const double touch_gain : {0.0, 0.05}) {
    SCOPED_TRACE(testing::Message() << "gain of a touch +- " << touch_gain);
    const simulation::SimulationOptions physics = rubber(touch_gain);
    const Recording weights = two_weights(array, physics, 1);
    const auto calibration = calibrate(array, weights.frames, weights.loads);
    ASSERT_TRUE(calibration) << calibration.error().message;
    ASSERT_TRUE(calibration->model.memory);
    const touch::fusion::MemoryLaw& law = *calibration->model.memory;
    // 10 % of the force after one second a decade, of that after long 8 %; the loop is 8 % wide.
    for (const float share : law.creep) EXPECT_NEAR(share, 0.08F, 0.035F);
    EXPECT_NEAR(std::accumulate(law.gap.begin(), law.gap.end(), 0.0F), 0.08F, 0.035F);
    EXPECT_NE(calibration->report.memory.find("the material remembers"), std::string::npos);
    EXPECT_EQ(calibration->report.memory.find("not known"), std::string::npos) << calibration->report.memory;

    const Recording test = touches(array, physics, 12);
    const auto evaluation = evaluate(calibration->model, test.frames, test.loads);
    ASSERT_TRUE(evaluation);
    const EstimatorResult& dermis = evaluation->estimators.front();
    EXPECT_LT(*dermis.relative_error.median, touch_gain > 0.0 ? 0.06 : 0.02);
    EXPECT_LT(*dermis.relative_error.p95, touch_gain > 0.0 ? 0.21 : 0.15);
    EXPECT_LT(*dermis.ghost_n.p99, 0.3);
  }
}

/// One frame a second: presses from rest, then touches of which each frame is a new one.
Recording presses_and_touches(const ArrayDescription& array, const simulation::SimulationOptions& physics) {
  Recording all = record(array, "calibration", 1, physics);
  const Recording touched = record(array, "multitouch", 3, physics, 400);
  const std::size_t before = all.frames.size();
  const Nanos begin = all.frames.back().time + std::chrono::minutes(1);
  for (RawFrame frame : touched.frames) {
    frame.time += begin;
    all.frames.push_back(frame);
  }
  for (Load load : touched.loads) {
    load.frame += before;
    all.loads.push_back(load);
  }
  return all;
}

TEST(MemoryTraining, one_frame_a_second_tells_of_memory_where_loads_follow_each_other) {
  const ArrayDescription array = reference_array(4, 4);
  simulation::SimulationOptions physics;
  physics.rubber.hysteresis = 0.10;
  physics.rubber.creep = 0.05;
  const Recording recording = presses_and_touches(array, physics);
  const auto database = build_sample_database(array, recording.frames, recording.loads);
  ASSERT_TRUE(database);
  const auto plain = calibrate(*database);
  const auto calibration = calibrate(*database, recording.frames);
  ASSERT_TRUE(plain && calibration);
  ASSERT_TRUE(calibration->model.memory);
  const std::array<float, 3>& gap = calibration->model.memory->gap;
  EXPECT_NEAR(std::accumulate(gap.begin(), gap.end(), 0.0F), 0.10F, 0.04F);
  EXPECT_NE(calibration->report.memory.find("s apart: what comes sooner is not known"), std::string::npos)
      << calibration->report.memory;
  const Recording test = record(array, "multitouch", 2, physics, 400);
  const auto without = evaluate(plain->model, test.frames, test.loads);
  const auto with = evaluate(calibration->model, test.frames, test.loads);
  ASSERT_TRUE(without && with);
  EXPECT_LT(*with->estimators.front().relative_error.p95, 0.6 * *without->estimators.front().relative_error.p95);
}

TEST(MemoryTraining, single_presses_do_not_follow_each_other) {
  const ArrayDescription array = reference_array(3, 3);
  const Recording presses = record(array, "calibration", 1);
  const Recording with_touches = presses_and_touches(array, {});
  EXPECT_FALSE(loads_follow_each_other({}, {}));
  for (const auto& [recording, follow] : {std::pair(&presses, false), std::pair(&with_touches, true)}) {
    const auto database = build_sample_database(array, recording->frames, recording->loads);
    ASSERT_TRUE(database);
    EXPECT_EQ(loads_follow_each_other(*database, recording->frames), follow);
  }
}

/// Recordings of one taxel each, put together as if the next began a few seconds after the last.
Recording put_together(const ArrayDescription& array, simulation::SimulationOptions physics) {
  physics.scene = {.rate_hz = 20.0, .taxels = 1};
  Recording all;
  Nanos begin{};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Recording one = record(array, "two_weights", seed, physics);
    for (Load load : one.loads) {
      load.frame += all.frames.size();
      all.loads.push_back(load);
    }
    for (RawFrame frame : one.frames) {
      frame.time += begin;
      all.frames.push_back(frame);
    }
    begin = all.frames.back().time + std::chrono::seconds(2);
  }
  return all;
}

TEST(MemoryTraining, pauses_that_nobody_waited_do_not_mislead) {
  const ArrayDescription array = reference_array(1, 2);
  const simulation::SimulationOptions physics = rubber(0.0);
  const Recording pieces = put_together(array, physics);
  const auto calibration = calibrate(array, pieces.frames, pieces.loads);
  ASSERT_TRUE(calibration) << calibration.error().message;
  ASSERT_TRUE(calibration->model.memory);
  for (const float share : calibration->model.memory->creep) EXPECT_NEAR(share, 0.08F, 0.03F);
}

/// Whether tracking changes forces of at least a newton or loses their contact, and what it makes of taxels that a load
/// has left.
struct Tracked {
  double worst_change = 0.0;  // relative
  double worst_ghost = 0.0;   // [N]
  double least = 0.0;         // [N]
  std::size_t lost = 0;       // loads of at least a newton without a contact
};

Tracked tracked(const touch::pipeline::Model& model, const Recording& recording) {
  auto with = touch::pipeline::Pipeline::create(model);
  auto without = touch::pipeline::Pipeline::create(model);
  with->drift().set_options({.track = true});
  std::map<std::size_t, std::map<std::size_t, double>> truth;  // by frame and taxel
  for (const Load& load : recording.loads) {
    for (std::size_t row = load.where.first_row; row <= load.where.last_row; ++row) {
      for (std::size_t col = load.where.first_col; col <= load.where.last_col; ++col) {
        truth[load.frame][model.array.index(row, col)] = load.value;
      }
    }
  }
  Tracked result;
  touch::contacts::ContactTracker tracker(model.array);
  ContactReport report;
  ForceFrame force;
  ForceFrame plain;
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    with->process(recording.frames[frame], force);
    without->process(recording.frames[frame], plain);
    tracker.process(force, report);
    for (const float newtons : force.newtons) result.least = std::min(result.least, static_cast<double>(newtons));
    for (const auto& [taxel, newtons] : truth[frame]) {
      const auto given = static_cast<double>(force.newtons[taxel]);
      if (newtons == 0.0) result.worst_ghost = std::max(result.worst_ghost, given);
      if (newtons < 1.0) continue;
      if (report.contacts.empty()) ++result.lost;
      const double change = given / static_cast<double>(plain.newtons[taxel]) - 1.0;
      result.worst_change = std::max(result.worst_change, std::abs(change));
    }
  }
  return result;
}

TEST(MemoryTraining, the_dip_after_a_release_is_no_drift) {
  const ArrayDescription array = reference_array(2, 3);
  for (const double unloaded_ohm : {200e3, 10e3}) {
    SCOPED_TRACE(testing::Message() << "unloaded " << unloaded_ohm << " ohm");
    simulation::SimulationOptions physics = rubber(0.0);
    physics.rubber.unloaded_ohm = unloaded_ohm;
    const Recording weights = two_weights(array, physics, 1);
    const auto calibration = calibrate(array, weights.frames, weights.loads);
    ASSERT_TRUE(calibration) << calibration.error().message;
    ASSERT_TRUE(calibration->model.memory);
    const Tracked result = tracked(calibration->model, two_weights(array, physics, 2));
    EXPECT_GE(result.least, 0.0);
    EXPECT_EQ(result.lost, 0U);
    EXPECT_LT(result.worst_change, 0.05);
    EXPECT_LT(result.worst_ghost, 0.3);
  }
}

TEST(MemoryTraining, a_material_without_memory_gets_the_same_model_as_ever) {
  const ArrayDescription array = reference_array(2, 3);
  const Recording weights = two_weights(array, {}, 3);
  const auto database = build_sample_database(array, weights.frames, weights.loads);
  ASSERT_TRUE(database);
  const auto plain = calibrate(*database);
  const auto calibration = calibrate(*database, weights.frames);
  ASSERT_TRUE(plain && calibration);
  EXPECT_FALSE(calibration->model.memory);
  EXPECT_TRUE(calibration->report.memory.empty());
  EXPECT_EQ(calibration->model.networks.parameters, plain->model.networks.parameters);
  EXPECT_EQ(calibration->model.networks.relative_sigma, plain->model.networks.relative_sigma);
}

TEST(MemoryTraining, frames_that_are_far_apart_tell_nothing_of_memory) {
  const ArrayDescription array = reference_array(2, 2);
  EXPECT_FALSE(is_continuous(record(array, "calibration", 1).frames));
  EXPECT_FALSE(is_continuous({}));
  EXPECT_TRUE(is_continuous(touches(array, {}, 1).frames));
}

TEST(MemoryTraining, says_what_the_recording_cannot_tell) {
  LearnedMemory memory;
  memory.law.creep = {0.1F, 0.1F, 0.1F, 0.1F};
  memory.longest_hold_seconds = 2.0;
  const std::string text = describe(memory);
  EXPECT_NE(text.find("no load lies still for more than 2 s"), std::string::npos) << text;
  EXPECT_NE(text.find("unloading is not known"), std::string::npos) << text;
}

}  // namespace
}  // namespace dermis::learn::calibration
