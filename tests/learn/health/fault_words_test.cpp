// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/fault_words.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

using touch::compensation::LineFault;
using touch::compensation::LineFaultKind;

ArrayDescription array_of_4_by_5() {
  return support::hand_made_model(4, 5).array;
}

LineFault fault_of(LineFaultKind kind, std::size_t place) {
  LineFault fault;
  fault.kind = kind;
  fault.place = place;
  fault.frame = 7;
  return fault;
}

std::string words_of(const LineFault& fault) {
  return describe(FaultHistory{fault}, array_of_4_by_5());
}

TEST(FaultWords, a_line_that_is_silent_may_be_open_or_grounded) {
  LineFault fault = fault_of(LineFaultKind::silent_row, 3);
  EXPECT_EQ(words_of(fault),
            "is open or shorted to 0 V since frame 7: check the wire or crimp of row 3; its 5 taxels are masked, the "
            "rest is still good");
  fault.ground_evidence = -3.0;
  EXPECT_TRUE(words_of(fault).starts_with("is open since frame 7: check the wire or crimp of row 3; "));
  fault.grounded = true;
  EXPECT_TRUE(
      words_of(fault).starts_with("is shorted to 0 V since frame 7: look for a bridge between row 3 and ground"));
}

TEST(FaultWords, each_kind_says_how_many_taxels_are_masked) {
  for (const auto& [kind, words] : {std::pair{LineFaultKind::silent_column, "its 4 taxels are masked"},
                                    std::pair{LineFaultKind::supplied_row, "its 5 taxels are masked"},
                                    std::pair{LineFaultKind::supplied_column, "its 4 taxels are masked"},
                                    std::pair{LineFaultKind::shorted_rows, "its 10 taxels are masked"},
                                    std::pair{LineFaultKind::shorted_columns, "its 8 taxels are masked"},
                                    std::pair{LineFaultKind::stuck_taxel, "the taxel is masked"},
                                    std::pair{LineFaultKind::dead_taxel, "the taxel is masked"}}) {
    SCOPED_TRACE(touch::compensation::to_string(kind));
    EXPECT_NE(words_of(fault_of(kind, 1)).find(words), std::string::npos) << words_of(fault_of(kind, 1));
  }
}

TEST(FaultWords, readings_without_an_explanation_name_their_lines) {
  EXPECT_EQ(
      words_of(fault_of(LineFaultKind::shorted_crossing, 13)),
      "is shorted: row 2 and column 3 touch since frame 7: look for a bridge between the two; the taxel is masked, "
      "the rest is still good");
  EXPECT_EQ(words_of(fault_of(LineFaultKind::impossible_reading, 13)),
            "reads more than the circuit can give since frame 7: check the electronics that read taxel r2c3; the taxel "
            "is masked, the rest is still good");
}

TEST(FaultWords, a_driver_that_drifts_masks_nothing) {
  LineFault fault = fault_of(LineFaultKind::drifting_driver, 2);
  fault.drive_ohm = 61.4;
  EXPECT_EQ(words_of(fault),
            "has risen from 20 to about 61 ohm since frame 7: check the contact between the driver of row 2 and its "
            "line for corrosion, or calibrate again; until then heavy loads on the line read too little");
}

TEST(FaultWords, a_fault_that_went_comes_and_goes) {
  const FaultHistory history{fault_of(LineFaultKind::dead_taxel, 11), 20};
  EXPECT_EQ(
      describe(history, array_of_4_by_5()),
      "is dead: it reads less than an unloaded taxel from frame 7 to 19: check the contact of taxel r2c1 with its "
      "lines; it comes and goes, as a loose contact does");
}

TEST(Condition, an_array_without_faults_is_healthy) {
  const Condition condition = condition_of(support::hand_made_model(4, 5), {});
  EXPECT_EQ(condition.message, "healthy");
  EXPECT_TRUE(condition.details.empty());
}

TEST(Condition, taxels_dead_since_calibration_are_named) {
  touch::pipeline::Model model = support::hand_made_model(4, 5);
  model.networks.dead[3] = 1;
  model.networks.dead[12] = 1;
  const Condition condition = condition_of(model, {});
  EXPECT_EQ(condition.message, "dead taxels");
  ASSERT_EQ(condition.details.size(), 1U);
  EXPECT_EQ(condition.details[0], (std::pair<std::string, std::string>{"dead since calibration", "r0c3 r2c2"}));
}

TEST(Condition, faults_stand_before_dead_taxels_in_the_words_of_the_diagnosis) {
  touch::pipeline::Model model = support::hand_made_model(4, 5);
  model.networks.dead[3] = 1;
  const std::vector<LineFault> faults{fault_of(LineFaultKind::silent_row, 1),
                                      fault_of(LineFaultKind::shorted_columns, 2)};
  const Condition condition = condition_of(model, faults);
  EXPECT_EQ(condition.message, "2 faults");
  ASSERT_EQ(condition.details.size(), 3U);
  EXPECT_EQ(condition.details[0].first, "row 1");
  EXPECT_EQ(condition.details[0].second, words_of(faults[0]));
  EXPECT_EQ(condition.details[1].first, "columns 2 and 3");
  EXPECT_EQ(condition.details[2].first, "dead since calibration");
  EXPECT_EQ(condition_of(model, std::span(faults).first(1)).message, "1 fault");
}

}  // namespace
}  // namespace dermis::learn::health
