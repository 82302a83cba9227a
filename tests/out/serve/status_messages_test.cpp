// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/status_messages.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "out/serve/calibration/calibration_message.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::out::serve {
namespace {

using Level = bytes::ros_messages::Diagnosis::Level;
using Values = std::vector<std::pair<std::string, std::string>>;

TEST(StatusMessages, statistics_are_those_of_the_array_and_its_source) {
  live::suits::ArrayStatistics array;
  array.source.lost_frames = 1;
  array.source.damaged_frames = 2;
  array.source.rate_hz = 99.5;
  array.source.jitter = std::chrono::microseconds(300);
  array.frames = 3;
  array.rejected = 4;
  array.latency_p50 = std::chrono::milliseconds(1);
  array.latency_p99 = std::chrono::milliseconds(2);
  array.temperature_celsius = 25.0;
  array.supply_v = 5.0;
  array.ended = true;
  array.error = "the cable is torn";
  const bytes::ros_messages::ArrayStatistics message = statistics_message("chest", array);
  EXPECT_EQ(message.name, "chest");
  EXPECT_TRUE(message.ended);
  EXPECT_EQ(message.error, "the cable is torn");
  EXPECT_EQ((std::vector<std::uint64_t>{message.lost, message.damaged, message.frames, message.rejected}),
            (std::vector<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_EQ(message.rate_hz, 99.5);
  EXPECT_DOUBLE_EQ(message.jitter_s, 300e-6);
  EXPECT_DOUBLE_EQ(message.latency_p50_s, 1e-3);
  EXPECT_DOUBLE_EQ(message.latency_p99_s, 2e-3);
  EXPECT_EQ(message.temperature_celsius, 25.0);
  EXPECT_EQ(message.supply_v, 5.0);
}

TEST(StatusMessages, what_is_not_known_is_not_a_number) {
  const bytes::ros_messages::ArrayStatistics message = statistics_message("chest", {});
  EXPECT_TRUE(std::isnan(message.latency_p50_s));
  EXPECT_TRUE(std::isnan(message.latency_p99_s));
  EXPECT_TRUE(std::isnan(message.temperature_celsius));
  EXPECT_TRUE(std::isnan(message.supply_v));
}

TEST(StatusMessages, a_fleet_hears_of_faults_and_of_gains) {
  const touch::pipeline::Model model = support::hand_made_model(3, 4);
  live::suits::ArrayStatistics statistics;
  statistics.source.rate_hz = 99.5;
  statistics.source.lost_frames = 2;
  statistics.faults = {{.kind = touch::compensation::LineFaultKind::silent_row, .place = 1},
                       {.kind = touch::compensation::LineFaultKind::silent_column, .place = 1}};
  live::fleet::ArrayHealth array{.name = "chest"};
  fill_in(array, model, statistics,
          {.comparisons = 500, .blocks = 60, .gain_spread = 0.2, .spread_sigma = 0.01, .calibrated_spread = 0.02});
  const live::fleet::ArrayHealth expected{.name = "chest",
                                          .level = live::fleet::ArrayHealth::Level::warning,
                                          .message = "2 faults",
                                          .rate_hz = 99.5,
                                          .lost = 2,
                                          .masked_taxels = 7,
                                          .gain_change = 0.2,
                                          .wants_calibration = true};
  EXPECT_EQ(array, expected);
}

TEST(StatusMessages, an_array_without_a_model_is_to_be_calibrated) {
  const touch::pipeline::Model model = learn::calibration::uncalibrated_model(support::hand_made_model(3, 4).array);
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", model, {});
  EXPECT_EQ(diagnosis.level, Level::warning);
  EXPECT_EQ(diagnosis.message, "not calibrated yet: calibrate");
  EXPECT_EQ(diagnosis.values, Values{});
}

TEST(StatusMessages, an_array_without_a_model_that_cannot_be_read_is_not_called_dead_since_calibration) {
  const touch::pipeline::Model model = learn::calibration::uncalibrated_model(support::hand_made_model(3, 4).array);
  live::suits::ArrayStatistics statistics;
  statistics.error = "these bytes are of no known protocol";
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", model, statistics);
  EXPECT_EQ(diagnosis.message, statistics.error);
  EXPECT_EQ(diagnosis.values, Values{});
}

TEST(StatusMessages, a_whole_array_is_healthy) {
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", support::hand_made_model(3, 4), {});
  EXPECT_EQ(diagnosis.level, Level::ok);
  EXPECT_EQ(diagnosis.name, "chest");
  EXPECT_EQ(diagnosis.hardware_id, "hand made");
  EXPECT_EQ(diagnosis.message, "healthy");
  EXPECT_EQ(diagnosis.values, Values{});
}

TEST(StatusMessages, dead_taxels_are_named_and_no_warning) {
  touch::pipeline::Model model = support::hand_made_model(3, 4);
  model.networks.dead[1] = 1;
  model.networks.dead[4] = 1;
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", model, {});
  EXPECT_EQ(diagnosis.level, Level::ok);
  EXPECT_EQ(diagnosis.message, "dead taxels");
  EXPECT_EQ(diagnosis.values, (Values{{"dead since calibration", "r0c1 r1c0"}}));
}

TEST(StatusMessages, gains_that_have_changed_are_a_warning_with_the_evidence) {
  learn::health::AgeingEvidence ageing;
  ageing.comparisons = 214;
  ageing.gain_spread = 0.02;
  ageing.spread_sigma = 0.01;
  const touch::pipeline::Model model = support::hand_made_model(3, 4);
  EXPECT_EQ(diagnosis_message("chest", model, {}, ageing).level, Level::ok);
  EXPECT_EQ(diagnosis_message("chest", model, {}, ageing).message, "healthy");
  ageing.gain_spread = 0.09;
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", model, {}, ageing);
  EXPECT_EQ(diagnosis.level, Level::warning);
  EXPECT_EQ(diagnosis.message, "recalibrate: gains have changed by about 9 %");
  EXPECT_EQ(diagnosis.values,
            (Values{{"gains",
                     "recalibrate: gains have changed by about 9 % from taxel to taxel (\u00b1 1 %, 214 "
                     "comparisons)"}}));
}

TEST(StatusMessages, faults_of_lines_are_a_warning_each_with_its_place) {
  live::suits::ArrayStatistics statistics;
  statistics.faults.push_back({.kind = touch::compensation::LineFaultKind::silent_row, .place = 1});
  const touch::pipeline::Model model = support::hand_made_model(3, 4);
  EXPECT_EQ(diagnosis_message("chest", model, statistics).message, "1 fault");
  statistics.faults.push_back({.kind = touch::compensation::LineFaultKind::silent_column, .place = 2});
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message("chest", model, statistics);
  EXPECT_EQ(diagnosis.level, Level::warning);
  EXPECT_EQ(diagnosis.message, "2 faults");
  EXPECT_EQ(diagnosis.values, (Values{{"row 1",
                                       "is open or shorted to 0 V since frame 0: check the wire or crimp of row 1; its "
                                       "4 taxels are masked, the rest is still good"},
                                      {"column 2",
                                       "is open or shorted to 0 V since frame 0: check the wire or crimp of column 2; "
                                       "its 3 taxels are masked, the rest is still good"}}));
}

TEST(StatusMessages, what_ended_the_source_comes_before_faults) {
  live::suits::ArrayStatistics statistics;
  statistics.faults.push_back({.kind = touch::compensation::LineFaultKind::silent_row, .place = 1});
  statistics.ended = true;
  const touch::pipeline::Model model = support::hand_made_model(3, 4);
  EXPECT_EQ(diagnosis_message("chest", model, statistics).level, Level::stale);
  EXPECT_EQ(diagnosis_message("chest", model, statistics).message, "the source has ended");
  statistics.error = "the cable is torn";
  EXPECT_EQ(diagnosis_message("chest", model, statistics).level, Level::error);
  EXPECT_EQ(diagnosis_message("chest", model, statistics).message, "the cable is torn");
}

TEST(StatusMessages, a_calibration_is_told_with_all_that_the_guide_says) {
  learn::calibration::GuideState guide;
  guide.stage = learn::calibration::GuideStage::pressing;
  guide.hint = learn::calibration::GuideHint::other_taxel;
  guide.message = "press r1c1";
  guide.taxel = 5;
  guide.weight_n = 2.0;
  guide.reading = 3.0;
  guide.hold_share = 0.5;
  guide.pressed_taxel = 6;
  guide.presses_done = 7;
  guide.presses_total = 8;
  guide.median_relative_error = 0.01;
  guide.unpressed_relative_error = 0.02;
  guide.taxel_presses = {1, 0, 2};
  guide.together_with = 9;
  guide.together_reading = 4.0;
  guide.missing_taxel = 5;
  const bytes::ros_messages::CalibrationState message = calibration_message({"chest", guide});
  EXPECT_EQ(message.array, "chest");
  EXPECT_EQ(message.stage, bytes::ros_messages::CalibrationState::Stage::pressing);
  EXPECT_EQ(message.hint, bytes::ros_messages::CalibrationState::Hint::other_taxel);
  EXPECT_EQ(message.message, "press r1c1");
  EXPECT_EQ(message.taxel, 5U);
  EXPECT_EQ(message.weight_n, 2.0);
  EXPECT_EQ(message.reading, 3.0);
  EXPECT_EQ(message.hold_share, 0.5);
  EXPECT_EQ(message.pressed_taxel, 6U);
  EXPECT_EQ(message.presses_done, 7U);
  EXPECT_EQ(message.presses_total, 8U);
  EXPECT_EQ(message.median_relative_error, 0.01);
  EXPECT_EQ(message.unpressed_relative_error, 0.02);
  EXPECT_EQ(message.taxel_presses, (std::vector<std::uint8_t>{1, 0, 2}));
  EXPECT_EQ(message.together_with, 9U);
  EXPECT_EQ(message.together_reading, 4.0);
  EXPECT_EQ(message.missing_taxel, 5U);
}

TEST(StatusMessages, what_is_not_known_of_a_calibration_is_no_number_and_no_taxel) {
  const bytes::ros_messages::CalibrationState message = calibration_message({"chest", {}});
  EXPECT_EQ(message.stage, bytes::ros_messages::CalibrationState::Stage::none);
  EXPECT_FALSE(message.pressed_taxel);
  EXPECT_FALSE(message.together_with);
  EXPECT_FALSE(message.missing_taxel);
  EXPECT_TRUE(std::isnan(message.together_reading));
  EXPECT_TRUE(std::isnan(message.median_relative_error));
  EXPECT_TRUE(std::isnan(message.unpressed_relative_error));
}

}  // namespace
}  // namespace dermis::out::serve
