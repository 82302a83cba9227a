// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A circuit that array.toml gives, beside frames of another one: ten weights on 16 of 64 taxels, each alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::uint64_t kSeeds = 3;

ArrayDescription described(Circuit circuit, IdleRows idle_rows = IdleRows::grounded,
                           IdleColumns idle_columns = IdleColumns::loaded) {
  ArrayDescription array = reference_array(8, 8);
  array.readout.circuit = circuit;
  array.readout.idle_rows = idle_rows;
  array.readout.idle_columns = idle_columns;
  array.readout.drive_ohm.assign(8, 90.0);
  array.readout.load_ohm.assign(8, 220.0);
  if (circuit != Circuit::none) return array;
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  return array;
}

ArrayDescription grounded_divider() {
  return described(Circuit::divider);
}

std::vector<ArrayDescription> kinds() {
  return {grounded_divider(), described(Circuit::divider, IdleRows::floating),
          described(Circuit::divider, IdleRows::grounded, IdleColumns::floating), described(Circuit::transimpedance)};
}

/// Every press lifts its row and its column.
ArrayDescription two_wires(double drive_ohm, double load_ohm) {
  ArrayDescription array = described(Circuit::divider, IdleRows::floating, IdleColumns::floating);
  array.readout.drive_ohm.assign(8, drive_ohm);
  array.readout.load_ohm.assign(8, load_ohm);
  return array;
}

/// Presses on every second row and column.
Recording presses_on(const ArrayDescription& truth, std::uint64_t seed) {
  Recording recording = record(truth, "calibration", seed);
  std::erase_if(recording.loads, [](const Load& load) {
    return load.value > 0.0 && (load.where.first_row % 2 == 1 || load.where.first_col % 2 == 1);
  });
  return recording;
}

std::vector<std::string> doubts(const ArrayDescription& array, const Recording& recording) {
  const Result<SampleDatabase> database = build_sample_database(array, recording.frames, recording.loads);
  EXPECT_TRUE(database) << (database ? "" : database.error().message);
  return database ? database->doubts : std::vector<std::string>();
}

TEST(CircuitDoubt, leaves_a_circuit_that_is_right_alone) {
  for (const ArrayDescription& truth : kinds()) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const auto said = doubts(truth, presses_on(truth, seed));
      EXPECT_TRUE(said.empty()) << to_string(truth.readout.circuit) << " seed " << seed << ": " << said.front();
    }
  }
}

TEST(CircuitDoubt, leaves_resistances_alone_that_are_off_by_the_tolerance_of_parts) {
  ArrayDescription array = grounded_divider();
  array.readout.drive_ohm.assign(8, 85.0);
  array.readout.load_ohm.assign(8, 230.0);
  EXPECT_TRUE(doubts(array, presses_on(grounded_divider(), 1)).empty());
}

TEST(CircuitDoubt, names_the_circuit_that_explains_the_frames_of_one_that_is_described_as_another) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Recording recording = presses_on(grounded_divider(), seed);
    std::vector<ArrayDescription> wrong = kinds();
    wrong.front() = described(Circuit::none);
    for (const ArrayDescription& array : wrong) {
      const auto said = doubts(array, recording);
      ASSERT_EQ(said.size(), 1U) << to_string(array.readout.circuit) << " seed " << seed;
      EXPECT_NE(said.front().find("\"divider, idle rows grounded\""), std::string::npos) << said.front();
      EXPECT_NE(said.front().find("circuit = \"auto\""), std::string::npos) << said.front();
    }
  }
}

TEST(CircuitDoubt, names_an_array_of_two_wires_that_is_described_as_grounded) {
  const auto said = doubts(grounded_divider(), presses_on(two_wires(50.0, 1000.0), 1));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said.front().find("\"divider, idle rows and columns floating\""), std::string::npos) << said.front();
  EXPECT_NE(said.front().find("write idle_rows and idle_columns = \"floating\""), std::string::npos) << said.front();
}

/// The effect of a circuit looks like a law of the rubber there, and contacts scatter from taxel to taxel.
TEST(CircuitDoubt, is_not_raised_by_loads_on_the_whole_array_alone) {
  for (const ArrayDescription& truth : kinds()) {
    Recording recording = record(truth, "uniform", 1);
    const auto database = build_sample_database(truth, recording.frames, recording.loads);
    ASSERT_TRUE(database) << database.error().message;
    EXPECT_TRUE(database->doubts.empty()) << database->doubts.front();
  }
}

TEST(CircuitDoubt, names_two_wires_in_an_array_of_many_taxels) {
  ArrayDescription truth = two_wires(50.0, 1000.0);
  truth.rows = truth.cols = 12;
  truth.readout.drive_ohm.assign(12, 50.0);
  truth.readout.load_ohm.assign(12, 1000.0);
  Recording recording = record(truth, "paper_calibration", 1);
  std::erase_if(recording.loads, [](const Load& load) {
    return load.value > 0.0 && (load.where.first_row % 6 != 1 || load.where.first_col % 6 != 1);
  });
  ArrayDescription array = truth;
  array.readout.idle_rows = IdleRows::grounded;
  array.readout.idle_columns = IdleColumns::loaded;
  const auto database = build_sample_database(array, recording.frames, recording.loads);
  const std::string said = database && !database->doubts.empty() ? database->doubts.front()
                           : database                            ? ""
                                                                 : database.error().message;
  EXPECT_NE(said.find("\"divider, idle rows and columns floating\""), std::string::npos) << said;
}

TEST(CircuitDoubt, is_why_frames_cannot_be_used) {
  const Recording recording = presses_on(two_wires(100.0, 10e3), 1);
  const auto database = build_sample_database(grounded_divider(), recording.frames, recording.loads);
  ASSERT_FALSE(database);
  const std::string& message = database.error().message;
  EXPECT_NE(message.find("labelled frames cannot be used"), std::string::npos) << message;
  EXPECT_NE(message.find("these frames fit \"divider, idle rows and columns floating\""), std::string::npos) << message;
  EXPECT_EQ(message.find("stuck lines"), std::string::npos) << message;
}

TEST(CircuitDoubt, leaves_two_wires_that_are_described_alone) {
  const ArrayDescription truth = two_wires(50.0, 1000.0);
  EXPECT_TRUE(doubts(truth, presses_on(truth, 1)).empty());
}

TEST(CircuitDoubt, names_the_bits_of_an_adc_whose_end_no_reading_comes_near) {
  ArrayDescription array = grounded_divider();
  array.readout.adc_bits = 16;
  const auto said = doubts(array, presses_on(grounded_divider(), 1));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said.front().find("fit an ADC of 12 bits better than 16"), std::string::npos) << said.front();
}

TEST(CircuitDoubt, names_resistances_that_are_in_another_ratio) {
  ArrayDescription array = grounded_divider();
  array.readout.load_ohm.assign(8, 1100.0);
  const auto said = doubts(array, presses_on(grounded_divider(), 1));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said.front().find("better than the 0.082 of array.toml"), std::string::npos) << said.front();
}

TEST(CircuitDoubt, makes_forces_as_unsure_as_a_wrong_circuit_leaves_them) {
  const Recording recording = presses_on(grounded_divider(), 1);
  const auto right = build_sample_database(grounded_divider(), recording.frames, recording.loads);
  const auto wrong = build_sample_database(described(Circuit::transimpedance), recording.frames, recording.loads);
  ASSERT_TRUE(right && wrong);
  EXPECT_EQ(right->unexplained_share, 0.0);
  EXPECT_GE(wrong->unexplained_share, 0.5);
}

}  // namespace
}  // namespace dermis::learn::calibration
