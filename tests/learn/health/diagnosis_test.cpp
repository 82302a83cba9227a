// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/diagnosis.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

Diagnosis healthy() {
  Diagnosis diagnosis;
  diagnosis.frames = 401;
  diagnosis.seconds = 8.0;
  diagnosis.noise_counts = 1.04;
  diagnosis.offset_drift = -0.007;
  diagnosis.offset_spread = 0.012;
  diagnosis.ageing.gain_spread = 0.014;
  diagnosis.temperature = {24.0, 26.5};
  diagnosis.worst_misfit_sigma = 0.05;
  return diagnosis;
}

TEST(Diagnosis, a_healthy_array_is_called_healthy) {
  const touch::pipeline::Model model = support::hand_made_model(4, 5);
  EXPECT_TRUE(healthy().is_healthy());
  EXPECT_EQ(describe(healthy(), model),
            "array        hand made, 4 x 5, divider\n"
            "frames       401, 0 rejected, 8.0 s, 50.0 frames/s\n"
            "noise        1.04 counts, calibrated 1.00 counts\n"
            "saturated    0.00 % of all readings\n"
            "unloaded     -0.7 % against the calibration, 1.2 % from taxel to taxel\n"
            "gains        1.4 % from taxel to taxel against the calibration\n"
            "temperature  24.0 to 26.5 C, calibrated 5.0 to 45.0 C\n"
            "circuit      0 frames unsolved, worst misfit 0.05 standard deviations\n"
            "\n"
            "healthy\n");
}

TEST(Diagnosis, a_supply_that_has_a_part_in_the_forces_is_told) {
  touch::pipeline::Model model = support::hand_made_model(4, 5);
  Diagnosis diagnosis = healthy();
  diagnosis.supply = {4.71, 5.02};
  EXPECT_NE(describe(diagnosis, model).find("supply       4.71 to 5.02 V, unknown when calibrated\n"),
            std::string::npos);
  model.supply = {4.5, 5.5};
  EXPECT_NE(describe(diagnosis, model).find("supply       4.71 to 5.02 V, calibrated 4.50 to 5.50 V\n"),
            std::string::npos);
}

TEST(Diagnosis, what_is_not_known_is_called_unknown) {
  const touch::pipeline::Model model = support::hand_made_model(4, 5);
  const std::string text = describe(Diagnosis{}, model);
  EXPECT_NE(text.find("frames       0, 0 rejected, 0.0 s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("noise        unknown (touched all the time), calibrated 1.00 counts\n"), std::string::npos);
  EXPECT_NE(text.find("unloaded     unknown\n"), std::string::npos);
  EXPECT_NE(text.find("gains        unknown (too few touches of several taxels)\n"), std::string::npos);
  EXPECT_NE(text.find("temperature  unknown, calibrated 5.0 to 45.0 C\n"), std::string::npos);
}

TEST(Diagnosis, findings_stand_at_the_end_instead_of_healthy) {
  Diagnosis diagnosis = healthy();
  diagnosis.findings = {"row 2 is open", "3 frames rejected: a value is no number"};
  diagnosis.blind_lines = {"row 3", "column 1"};
  EXPECT_FALSE(diagnosis.is_healthy());
  const std::string text = describe(diagnosis, support::hand_made_model(4, 5));
  EXPECT_TRUE(
      text.ends_with("blind        2 of 9 lines read too little unloaded for a break to be seen\n"
                     "\n"
                     "row 2 is open\n"
                     "3 frames rejected: a value is no number\n"))
      << text;
}

TEST(Diagnosis, remarks_leave_an_array_healthy) {
  Diagnosis diagnosis = healthy();
  diagnosis.remarks = {"rows 2 and 3 may be shorted together"};
  EXPECT_TRUE(diagnosis.is_healthy());
  const std::string text = describe(diagnosis, support::hand_made_model(4, 5));
  EXPECT_TRUE(text.ends_with("\nhealthy\nremark: rows 2 and 3 may be shorted together\n")) << text;
}

}  // namespace
}  // namespace dermis::learn::health
