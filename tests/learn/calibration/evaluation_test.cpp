// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/evaluation.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/touch/pipeline/direct_model.hpp"
#include "learn/calibration/simulated.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::calibration {
namespace {

/// A model and a frame for which dermis is exact: a row of one taxel each, so that nothing couples.
touch::pipeline::Model exact_model() {
  touch::pipeline::Model model = support::hand_made_model(2, 2);
  model.array.readout.drive_ohm.assign(2, 0.0);
  model.networks.sigma_knots_newtons = {0.05F, 50.0F};
  return model;
}

/// Counts of the model's array under given forces at its centre temperature: ideal drivers, no noise.
RawFrame frame_under(const touch::pipeline::Model& model, const std::vector<double>& newtons) {
  const ArrayDescription& array = model.array;
  RawFrame frame;
  frame.temperature_celsius = model.networks.unloaded.temperature.centre_celsius;
  frame.counts.resize(newtons.size());
  std::vector<double> siemens;
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    siemens.push_back(support::siemens_under(model, taxel, newtons[taxel], *frame.temperature_celsius));
  }
  for (std::size_t col = 0; col < array.cols; ++col) {
    double column = 1.0 / array.readout.load_ohm[col];
    for (std::size_t row = 0; row < array.rows; ++row) column += siemens[array.index(row, col)];
    for (std::size_t row = 0; row < array.rows; ++row) {
      const std::size_t taxel = array.index(row, col);
      frame.counts[taxel] = static_cast<float>(siemens[taxel] / column * array.readout.full_scale_counts());
    }
  }
  return frame;
}

TEST(Evaluation, summarises_by_nearest_rank) {
  std::vector<double> errors;
  for (int k = 100; k >= 1; --k) errors.push_back(k);
  const ErrorSummary summary = summarise(errors);
  EXPECT_EQ(summary.count, 100U);
  EXPECT_EQ(summary.median, 50.0);
  EXPECT_EQ(summary.p95, 95.0);
  EXPECT_EQ(summary.p99, 99.0);
  EXPECT_EQ(summary.max, 100.0);
  EXPECT_FALSE(summarise({}).median.has_value());
  EXPECT_TRUE(std::isinf(*summarise({0.1, std::numeric_limits<double>::quiet_NaN()}).max));
}

TEST(Evaluation, judges_loaded_taxels_ghosts_and_totals) {
  const touch::pipeline::Model model = exact_model();
  const std::vector<RawFrame> frames = {frame_under(model, {5.0, 0.0, 0.0, 20.0}),
                                        frame_under(model, {3.0, 4.0, 0.0, 0.5}), frame_under(model, {0, 0, 0, 0})};
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 5.0 * 1.25},  // the label is off by a quarter
                                   {0, LoadKind::force, {1, 1, 1, 1}, 20.0},
                                   {1, LoadKind::force, {0, 0, 0, 1}, 8.0},  // 7 N in truth
                                   {1, LoadKind::force, {1, 1, 1, 1}, 0.5}};
  const Result<Evaluation> evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  EXPECT_EQ(evaluation->frames, 2U);
  const EstimatorResult& dermis = evaluation->estimators.front();
  EXPECT_EQ(dermis.name, "dermis");
  EXPECT_EQ(dermis.relative_error.count, 2U);  // 0.5 N is not judged
  EXPECT_NEAR(*dermis.relative_error.max, 0.2, 1e-3);
  EXPECT_NEAR(*dermis.relative_error.median, 0.0, 1e-3);
  EXPECT_EQ(dermis.ghost_n.count, 3U);  // r0c1, r1c0 of frame 0 and r1c0 of frame 1
  EXPECT_LT(*dermis.ghost_n.max, 0.01);
  EXPECT_EQ(dermis.totals_judged, 1U);
  EXPECT_NEAR(*dermis.total_rmse_n, 1.0, 0.01);
  EXPECT_NEAR(*dermis.total_relative_error.max, 1.0 / 8.0, 1e-3);
}

TEST(Evaluation, judges_from_a_fiftieth_of_the_heaviest_calibrated_load) {
  touch::pipeline::Model model = exact_model();
  model.networks.sigma_knots_newtons = {0.01F, 2.0F};
  const std::vector<RawFrame> frames = {frame_under(model, {0.039, 0, 0, 0}), frame_under(model, {0.041, 0, 0, 0})};
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 0.039},
                                   {1, LoadKind::force, {0, 0, 0, 0}, 0.041}};
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  EXPECT_NEAR(evaluation->judged_from_n, 0.04, 1e-6);
  ASSERT_EQ(evaluation->taxels.size(), 1U);
  EXPECT_EQ(evaluation->taxels.front().frame, 1U);
}

TEST(Evaluation, after_totals_judges_from_what_single_taxels_carried_of_them) {
  const ArrayDescription array = reference_array(4, 4);
  Recording recording = record(array, "uniform", 5);
  for (Load& load : recording.loads) {
    load.kind = LoadKind::force;
    load.value *= 16.0 * *array.taxel_area_m2;  // from a pressure on each of 16 taxels
  }
  const auto calibration = calibrate(array, recording.frames, recording.loads);
  ASSERT_TRUE(calibration) << calibration.error().message;
  const TrainingReport& report = calibration->report.training;
  EXPECT_NEAR(report.heaviest_taxel_newtons, report.heaviest_newtons / 16.0, 0.6 * report.heaviest_newtons / 16.0);
  const auto evaluation = evaluate(calibration->model, recording.frames, recording.loads);
  ASSERT_TRUE(evaluation);
  EXPECT_NEAR(evaluation->judged_from_n, report.heaviest_taxel_newtons / 50.0, 1e-5);
}

/// Two taxels whose readings are newtons.
touch::pipeline::Model pair_of_forces() {
  ArrayDescription array;
  array.rows = 1;
  array.cols = 2;
  array.readout.circuit = Circuit::none;
  array.readout.quantity = Quantity::force;
  return touch::pipeline::direct_model(array);
}

TEST(Evaluation, of_readings_that_are_forces_judges_from_what_the_loads_say) {
  const touch::pipeline::Model model = pair_of_forces();
  RawFrame frame;
  frame.counts = {0.25F, 0.004F};
  const auto evaluation =
      evaluate(model, std::vector<RawFrame>{frame},
               std::vector<Load>{{0, LoadKind::force, {0, 0, 0, 0}, 0.25}, {0, LoadKind::force, {0, 1, 0, 1}, 0.004}});
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  EXPECT_NEAR(evaluation->judged_from_n, 0.005, 1e-9);
  EXPECT_EQ(evaluation->taxels.size(), 1U);
}

TEST(Evaluation, of_readings_that_are_forces_judges_from_what_single_taxels_carry_of_totals) {
  const touch::pipeline::Model model = pair_of_forces();
  RawFrame frame;
  frame.counts = {3.0F, 5.0F};
  const auto judged_from = [&](double total) {
    const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 1}, total}};
    return evaluate(model, std::vector<RawFrame>{frame}, loads).value().judged_from_n;
  };
  EXPECT_NEAR(judged_from(8.0), 0.08, 1e-9);
  EXPECT_GT(judged_from(0.0), 0.0);
}

TEST(Evaluation, counts_separate_stressed_areas) {
  const touch::pipeline::Model model = exact_model();
  const std::vector<RawFrame> frames = {frame_under(model, {5.0, 0.0, 0.0, 5.0})};
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 5.0}, {0, LoadKind::force, {1, 1, 1, 1}, 5.0}};
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->taxels.size(), 2U);
  EXPECT_EQ(evaluation->taxels.front().contacts, 1U);  // they touch at a corner
  ASSERT_EQ(evaluation->by_contacts.size(), 1U);
  EXPECT_EQ(evaluation->by_contacts.front().low, 1.0);
}

TEST(Evaluation, breaks_down_every_judged_taxel_once) {
  const touch::pipeline::Model model = exact_model();
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
  for (const double newtons : {1.0, 1.9, 2.0, 9.0, 50.0, 70.0}) {
    loads.push_back({frames.size(), LoadKind::force, {0, 0, 0, 0}, newtons});
    frames.push_back(frame_under(model, {newtons, 0, 0, 0}));
    frames.back().supply_v = 5.0;
  }
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  for (const auto* bins :
       {&evaluation->by_force, &evaluation->by_temperature, &evaluation->by_supply, &evaluation->by_contacts}) {
    std::size_t count = 0;
    for (const BreakdownBin& bin : *bins) {
      ASSERT_EQ(bin.relative_error.size(), evaluation->estimators.size());
      count += bin.relative_error.front().count;
    }
    EXPECT_EQ(count, 6U);
  }
}

TEST(Evaluation, breaks_down_by_the_mean_of_several_sensors) {
  const touch::pipeline::Model model = exact_model();
  std::vector<RawFrame> frames = {frame_under(model, {5.0, 0.0, 0.0, 0.0})};
  frames[0].temperature_celsius.reset();
  frames[0].sensor_celsius = {31.0F, 35.0F};
  frames.push_back(frames[0]);
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 5.0}, {1, LoadKind::force, {0, 0, 1, 1}, 5.0}};
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_EQ(evaluation->by_temperature.size(), 1U);
  EXPECT_EQ(evaluation->by_temperature.front().low, 30.0);
  ASSERT_FALSE(evaluation->totals.empty());
  EXPECT_EQ(evaluation->totals.front().temperature_celsius, 33.0);
}

/// A press that comes, grows, is held, falls and goes, ten labels a second.
struct TimedPress {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

TimedPress timed_press(const touch::pipeline::Model& model, const TaxelRegion& where) {
  TimedPress press;
  for (const double newtons : {0.0, 0.0, 5.0, 5.02, 5.04, 8.0, 8.0, 8.0, 4.0, 4.0, 0.0, 0.0, 0.0, 0.0}) {
    press.loads.push_back({press.frames.size(), LoadKind::force, where, newtons});
    press.frames.push_back(frame_under(model, {newtons, 0, 0, 0}));
    press.frames.back().time = std::chrono::milliseconds(100) * press.frames.size();
  }
  return press;
}

TEST(Evaluation, tells_how_long_a_load_lay_whether_it_falls_and_what_stays_after_it) {
  const touch::pipeline::Model model = exact_model();
  const auto [frames, loads] = timed_press(model, {0, 0, 0, 0});
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->taxels.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(*evaluation->taxels[k].touch.seconds_since_onset, 0.1 * static_cast<double>(k), 1e-9);
    EXPECT_EQ(*evaluation->taxels[k].touch.is_unloading, k >= 6) << k;
  }
  ASSERT_EQ(evaluation->by_onset.size(), 2U);
  EXPECT_EQ(evaluation->by_onset[0].relative_error.front().count, 3U);
  ASSERT_EQ(evaluation->by_direction.size(), 2U);
  EXPECT_EQ(evaluation->by_direction[1].relative_error.front().count, 2U);
  ASSERT_EQ(evaluation->after_release.size(), 2U);
  EXPECT_EQ(evaluation->after_release[0].ghost_n.front().count, 3U);
  EXPECT_EQ(evaluation->after_release[1].low, 0.3);
}

TEST(Evaluation, tells_the_time_of_a_sum_that_is_alone_in_its_frames) {
  const touch::pipeline::Model model = exact_model();
  const auto [frames, loads] = timed_press(model, {0, 0, 1, 1});
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->totals.size(), 8U);
  EXPECT_NEAR(*evaluation->totals.back().touch.seconds_since_onset, 0.7, 1e-9);
  EXPECT_TRUE(*evaluation->totals.back().touch.is_unloading);
}

TEST(Evaluation, labels_that_are_seconds_apart_tell_nothing_of_time) {
  const touch::pipeline::Model model = exact_model();
  auto [frames, loads] = timed_press(model, {0, 0, 0, 0});
  for (RawFrame& frame : frames) frame.time *= 20;
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  EXPECT_TRUE(evaluation->by_onset.empty());
  EXPECT_TRUE(evaluation->by_direction.empty());
  EXPECT_TRUE(evaluation->after_release.empty());
}

TEST(Evaluation, counts_a_rejected_frame_apart) {
  const touch::pipeline::Model model = exact_model();
  std::vector<RawFrame> frames = {frame_under(model, {5.0, 0, 0, 0}), frame_under(model, {5.0, 0, 0, 0})};
  frames[1].supply_v = -1.0;
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 5.0}, {1, LoadKind::force, {0, 0, 0, 0}, 5.0}};
  const auto evaluation = evaluate(model, frames, loads);
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->frames, 1U);
  EXPECT_EQ(evaluation->frames_rejected, 1U);
}

TEST(Evaluation, has_the_documented_json_keys_and_no_bare_nan) {
  touch::pipeline::Model model = exact_model();
  model.networks.dead[0] = 1;  // gives NaN where 5 N presses
  const std::vector<RawFrame> frames = {frame_under(model, {5.0, 0, 0, 0})};
  const auto evaluation = evaluate(model, frames, std::vector<Load>{{0, LoadKind::force, {0, 0, 0, 0}, 5.0}});
  ASSERT_TRUE(evaluation);
  const std::string json = to_json(*evaluation);
  for (const char* key :
       {"estimators", "name", "median_relative_error", "p95_relative_error", "p99_relative_error", "max_relative_error",
        "ghost_p99_n", "ghost_max_n", "total_rmse_n", "taxels_judged", "by_force", "by_temperature", "by_supply",
        "by_contacts", "by_onset", "by_direction", "after_release"}) {
    EXPECT_NE(json.find("\"" + std::string(key) + "\""), std::string::npos) << key;
  }
  EXPECT_EQ(json.find("nan"), std::string::npos);
  EXPECT_EQ(json.find("inf"), std::string::npos);
  EXPECT_NE(json.find("\"max_relative_error\": null"), std::string::npos);
}

TEST(Evaluation, covered_shares_are_those_counted_by_hand) {
  std::vector<JudgedTaxel> taxels(5);
  for (JudgedTaxel& taxel : taxels) taxel = {0, 0, 10.0, {}, {}, 1, {10.0F}, 1.0F};
  taxels[0].newtons[0] = 10.5F;
  taxels[1].newtons[0] = 8.5F;
  taxels[2].newtons[0] = 13.0F;
  taxels[3].sigma_newtons = std::numeric_limits<float>::infinity();  // only a lower bound: not counted
  const std::vector<double> shares = covered_shares(taxels, std::vector<double>{0.1, 1.0, 2.0, 3.0});
  EXPECT_EQ(shares, (std::vector<double>{0.25, 0.5, 0.75, 1.0}));
  EXPECT_TRUE(covered_shares(std::span(taxels).subspan(3, 1), std::vector<double>{1.0}).empty());
}

TEST(Evaluation, coverage_is_in_the_result_its_breakdowns_and_the_json) {
  const touch::pipeline::Model model = exact_model();
  const std::vector<RawFrame> frames = {frame_under(model, {5.0, 0, 0, 0}), frame_under(model, {0, 20.0, 0, 0})};
  const std::vector<Load> loads = {{0, LoadKind::force, {0, 0, 0, 0}, 5.0}, {1, LoadKind::force, {0, 1, 0, 1}, 30.0}};
  const auto evaluation = evaluate(model, frames, loads);  // the second label is wrong by far more than sigma
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->coverage.count, 2U);
  EXPECT_EQ(evaluation->coverage.share_68, 0.5);
  EXPECT_EQ(evaluation->coverage.share_95, 0.5);
  ASSERT_EQ(evaluation->by_force.size(), 2U);
  EXPECT_EQ(evaluation->by_force[0].coverage.share_95, 1.0);
  EXPECT_EQ(evaluation->by_force[1].coverage.share_95, 0.0);
  EXPECT_EQ(evaluation->bound.frames, 2U);
  EXPECT_EQ(evaluation->bound.taxels, 2U);
  EXPECT_GT(evaluation->bound.median_bound, 0.0);
  for (const char* key : {"coverage_68", "coverage_95", "coverage_taxels", "cramer_rao_bound"}) {
    EXPECT_NE(to_json(*evaluation).find("\"" + std::string(key) + "\""), std::string::npos) << key;
  }
}

TEST(Evaluation, refuses_loads_without_frames) {
  const auto evaluation = evaluate(exact_model(), {}, std::vector<Load>{{0, LoadKind::force, {0, 0, 0, 0}, 5.0}});
  ASSERT_FALSE(evaluation);
  EXPECT_EQ(evaluation.error().message, "a load names frame 0, there are 0 (counted from 0)");
}

TEST(Evaluation, judges_totals_by_the_live_taxels_and_no_force_as_no_ghost) {
  touch::pipeline::Model model = exact_model();
  model.networks.dead[1] = 1;
  const std::vector<RawFrame> frames = {frame_under(model, {5.0, 0.0, 3.0, 0.0})};
  const auto total = evaluate(model, frames, std::vector<Load>{{0, LoadKind::force, {0, 0, 1, 1}, 8.0}});
  ASSERT_TRUE(total);
  EXPECT_NEAR(*total->estimators.front().total_rmse_n, 0.0, 0.01);
  const auto taxels =
      evaluate(model, frames,
               std::vector<Load>{{0, LoadKind::force, {0, 0, 0, 0}, 5.0}, {0, LoadKind::force, {1, 0, 1, 0}, 3.0}});
  ASSERT_TRUE(taxels);
  EXPECT_EQ(taxels->estimators.front().ghost_n.count, 1U);
  EXPECT_LT(*taxels->estimators.front().ghost_n.max, 0.01);
}

}  // namespace
}  // namespace dermis::learn::calibration
