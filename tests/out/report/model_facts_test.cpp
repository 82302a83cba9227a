// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/model_facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace dermis::out::report {
namespace {

std::string fact(const std::vector<Fact>& facts, const std::string& name) {
  const auto found = std::ranges::find(facts, name, &Fact::first);
  return found == facts.end() ? "not told" : found->second;
}

ArrayDescription small_array() {
  ArrayDescription array;
  array.name = "small";
  array.rows = 1;
  array.cols = 3;
  array.readout.drive_ohm = {20.0};
  array.readout.load_ohm = {180.0, 200.0, 220.0};
  return array;
}

TEST(ModelFacts, an_array_is_its_size_its_circuit_and_its_adc) {
  const std::vector<Fact> facts = array_facts(small_array());
  EXPECT_EQ(fact(facts, "taxels"), "1 rows x 3 columns");
  EXPECT_EQ(fact(facts, "circuit"), "divider");
  EXPECT_EQ(fact(facts, "idle rows"), "grounded");
  EXPECT_EQ(fact(facts, "drive"), "20 ohm");
  EXPECT_EQ(fact(facts, "load"), "180 to 220 ohm");
  EXPECT_EQ(fact(facts, "ADC"), "12 bit");
  EXPECT_EQ(fact(facts, "nominal supply"), "not told");
  EXPECT_EQ(fact(facts, "temperature sensors"), "not told");
}

TEST(ModelFacts, an_array_says_how_many_temperature_sensors_it_has) {
  ArrayDescription array = small_array();
  array.temperature_sensors = {{0, 0}, {0, 2}};
  EXPECT_EQ(fact(array_facts(array), "temperature sensors"), "2");
  array.temperature_sensors = sensors_on_each_taxel(1, 3);
  EXPECT_EQ(fact(array_facts(array), "temperature sensors"), "one on each taxel");
}

TEST(ModelFacts, a_calibration_is_told_in_the_order_in_which_one_asks) {
  touch::pipeline::Model model;
  model.array = small_array();
  model.networks.dead = {0, 1, 0};
  model.supply = {4.5, 5.5};
  model.provenance = {{"frames hash", "fnv1a64:0123"}, {"labelled frames", "70"}, {"loads", "0.5 to 50 N"}};
  const std::vector<Fact> facts = calibration_facts(model);
  EXPECT_EQ(facts.front(), Fact("labelled frames", "70"));
  EXPECT_EQ(facts.back(), Fact("frames hash", "fnv1a64:0123"));
  EXPECT_EQ(fact(facts, "loads"), "0.5 to 50 N");
  EXPECT_EQ(fact(facts, "supply"), "4.5 to 5.5 V");
  EXPECT_EQ(fact(facts, "dead taxels"), "r0c1");
  EXPECT_EQ(fact(facts, "memory"), "none was learned: creep and hysteresis stay in the forces");
}

TEST(ModelFacts, a_model_that_was_not_calibrated_says_so) {
  touch::pipeline::Model model;
  model.array = small_array();
  EXPECT_EQ(calibration_facts(model), (std::vector<Fact>{{"calibration", "the model says of none"}}));
}

}  // namespace
}  // namespace dermis::out::report
