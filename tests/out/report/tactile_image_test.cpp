// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/report/tactile_image.hpp"

#include <gtest/gtest.h>

#include "out/report/sample_evaluation.hpp"
#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

TEST(TactileImage, shows_four_stages) {
  const ArrayDescription array = sample_array(16, 16);
  const std::vector<Drawing> panels = tactile_panels(array, sample_example(16, 16, 1));
  ASSERT_EQ(panels.size(), 4U);
  EXPECT_NE(panels[0].description.find("raw"), std::string::npos);
  EXPECT_NE(panels[1].description.find("[mS]"), std::string::npos);
  EXPECT_NE(panels[3].description.find("truth"), std::string::npos);
  const std::string document = svg_document(tactile_image(array, sample_example(16, 16, 1)));
  EXPECT_EQ(xml_error(document), "");
  EXPECT_FALSE(has_bad_number(document));
}

TEST(TactileImage, gives_both_forces_one_scale) {
  const ArrayDescription array = sample_array(1, 1);
  const learn::calibration::TactileExample example{0, {0.5}, {1e-5}, {20.0F}, {40.0}};
  const std::vector<Drawing> panels = tactile_panels(array, example);
  EXPECT_NE(panels[1].description.find("[\u00b5S]"), std::string::npos);
  EXPECT_NE(panels[2].elements.find(">40</text>"), std::string::npos) << "the scale of the truth";
  EXPECT_NE(panels[3].elements.find(">40</text>"), std::string::npos);
}

TEST(TactileImage, has_no_siemens_without_a_circuit) {
  ArrayDescription array = sample_array(2, 2);
  array.readout.circuit = Circuit::none;
  const learn::calibration::TactileExample example{0, {0, 0, 0, 0.5}, {0, 0, 0, 0.4}, {0, 0, 0, 9.0F}, {0, 0, 0, 10.0}};
  EXPECT_EQ(tactile_panels(array, example)[1].description.find("S]"), std::string::npos);
}

TEST(TactileImage, takes_a_frame_without_load_and_without_forces) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const learn::calibration::TactileExample example{0, {0, 0}, {0, 0}, {nan, nan}, {0, 0}};
  const std::string document = svg_document(tactile_image(sample_array(1, 2), example));
  EXPECT_EQ(xml_error(document), "");
  EXPECT_FALSE(has_bad_number(document));
}

}  // namespace
}  // namespace dermis::out::report
