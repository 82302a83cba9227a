// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/possible_readings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/circuits.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kSigma = 1.0 / 4095.0;

struct Checked {
  explicit Checked(const ArrayDescription& array)
      : possible(array), ratio(array.taxel_count(), 0.001), taxels(array.taxel_count(), TaxelStatus::ok) {}

  std::size_t invalid() {
    possible.check(ratio, kSigma, taxels);
    return static_cast<std::size_t>(std::count(taxels.begin(), taxels.end(), TaxelStatus::invalid));
  }

  ReadingVerdict verdict(std::size_t taxel) {
    std::vector<ReadingVerdict> verdicts(ratio.size());
    possible.judge(ratio, kSigma, taxels, verdicts);
    return verdicts[taxel];
  }

  PossibleReadings possible;
  std::vector<double> ratio;
  std::vector<TaxelStatus> taxels;
};

std::vector<support::NamedCircuit> circuits_and_films() {
  std::vector<support::NamedCircuit> circuits = support::all_circuits();
  for (const support::NamedCircuit& circuit : support::circuits_with_film()) circuits.push_back(circuit);
  return circuits;
}

TEST(PossibleReadings, what_a_taxel_of_any_resistance_reads_is_possible_in_every_circuit) {
  constexpr std::uint64_t kSeed = 3;
  Random random(kSeed);
  for (const support::NamedCircuit& circuit : circuits_and_films()) {
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    const ArrayDescription array = support::random_array(circuit, 6, 5, random);
    Checked checked(array);
    const double largest_load = *std::max_element(array.readout.load_ohm.begin(), array.readout.load_ohm.end());
    for (const double least_ohm : {std::max(15.0, 0.03 * largest_load), 200.0, 1e4}) {
      const auto siemens = support::random_siemens(array, random, least_ohm, 1e5);
      learn::simulation::ReadoutCircuit::create(array).value().ratios(siemens, checked.ratio);
      EXPECT_EQ(checked.invalid(), 0U) << "from " << least_ohm << " ohm";
    }
  }
}

TEST(PossibleReadings, more_than_a_taxel_of_0_ohm_reads_is_impossible) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  checked.ratio[array.index(2, 5)] = 0.95;  // 200 / 220 at most
  EXPECT_EQ(checked.verdict(array.index(2, 5)), ReadingVerdict::impossible);
  EXPECT_EQ(checked.invalid(), 1U);
  EXPECT_EQ(checked.taxels[array.index(2, 5)], TaxelStatus::invalid);
}

TEST(PossibleReadings, the_current_of_a_row_leaves_less_for_each_of_its_taxels) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  for (std::size_t col = 0; col < 6; ++col) checked.ratio[array.index(2, col)] = 0.5;
  EXPECT_EQ(checked.invalid(), 0U);
  checked.ratio[array.index(2, 9)] = 0.8;  // 1 - 20 / 200 (6 0.5 + 0.8) is 0.62
  EXPECT_EQ(checked.invalid(), 1U);
  EXPECT_EQ(checked.taxels[array.index(2, 9)], TaxelStatus::invalid);
}

TEST(PossibleReadings, a_column_reads_less_than_the_supply_in_all_rows_together) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  checked.ratio[array.index(2, 9)] = 0.6;
  checked.ratio[array.index(7, 9)] = 0.5;
  EXPECT_EQ(checked.invalid(), 1U);
  EXPECT_EQ(checked.taxels[array.index(2, 9)], TaxelStatus::invalid);
}

TEST(PossibleReadings, a_reading_that_leaves_a_few_ohm_is_a_short) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  const std::size_t taxel = array.index(2, 5);
  for (const auto& [ohm, verdict] : {std::pair{2.0, ReadingVerdict::shorted}, {15.0, ReadingVerdict::possible}}) {
    checked.ratio[taxel] = 200.0 / (220.0 + ohm);
    EXPECT_EQ(checked.verdict(taxel), verdict) << ohm;
  }
}

TEST(PossibleReadings, two_rows_that_touch_one_column_are_shorts_though_neither_reads_much) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  for (const std::size_t row : {3U, 8U}) checked.ratio[array.index(row, 5)] = 1.0 / (2.0 + 20.0 / 200.0);
  checked.ratio[array.index(1, 5)] = 0.01;
  EXPECT_EQ(checked.verdict(array.index(3, 5)), ReadingVerdict::shorted);
  EXPECT_EQ(checked.verdict(array.index(8, 5)), ReadingVerdict::shorted);
  EXPECT_EQ(checked.verdict(array.index(1, 5)), ReadingVerdict::possible);
}

TEST(PossibleReadings, two_columns_that_touch_one_row_are_shorts_though_the_row_has_fallen) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  for (const std::size_t col : {2U, 9U}) checked.ratio[array.index(4, col)] = 1.0 / (1.0 + 2.0 * 20.0 / 200.0);
  EXPECT_EQ(checked.verdict(array.index(4, 2)), ReadingVerdict::shorted);
  EXPECT_EQ(checked.verdict(array.index(4, 9)), ReadingVerdict::shorted);
}

TEST(PossibleReadings, a_reading_that_was_taken_away_comes_back_only_clearly_below_its_limit) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  const std::size_t taxel = array.index(2, 5);
  const auto is_taken_with = [&](double ohm) {
    std::fill(checked.taxels.begin(), checked.taxels.end(), TaxelStatus::ok);
    checked.ratio[taxel] = 200.0 / (220.0 + ohm);
    return checked.invalid() == 1U;
  };
  EXPECT_FALSE(is_taken_with(15.0));
  EXPECT_TRUE(is_taken_with(2.0));
  EXPECT_TRUE(is_taken_with(15.0));
  EXPECT_FALSE(is_taken_with(60.0));
  EXPECT_FALSE(is_taken_with(15.0));
}

TEST(PossibleReadings, a_wide_press_is_no_short_in_any_circuit_and_load) {
  for (const support::NamedCircuit& circuit : circuits_and_films()) {
    for (const double load_ohm : {200.0, 1500.0, 2700.0, 10e3}) {
      SCOPED_TRACE(testing::Message() << circuit << ", " << load_ohm << " ohm");
      Random random(1);
      ArrayDescription array = support::random_array(circuit, 12, 10, random);
      std::fill(array.readout.drive_ohm.begin(), array.readout.drive_ohm.end(), 20.0);
      std::fill(array.readout.load_ohm.begin(), array.readout.load_ohm.end(), load_ohm);
      std::vector<double> siemens(array.taxel_count(), 1e-5);
      for (std::size_t row = 1; row < 10; ++row) {
        for (std::size_t col = 1; col < 9; ++col) siemens[array.index(row, col)] = 1.0 / 500.0;
      }
      Checked checked(array);
      learn::simulation::ReadoutCircuit::create(array).value().ratios(siemens, checked.ratio);
      EXPECT_EQ(checked.invalid(), 0U);
    }
  }
}

TEST(PossibleReadings, heavy_loads_on_several_rows_and_columns_join_none) {
  constexpr std::uint64_t kSeed = 55;
  Random random(kSeed);
  ArrayDescription array = support::reference_circuit(10, 10);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", trial " << trial);
    std::fill(array.readout.drive_ohm.begin(), array.readout.drive_ohm.end(), random.uniform(1.0, 30.0));
    std::fill(array.readout.load_ohm.begin(), array.readout.load_ohm.end(), random.uniform(100.0, 300.0));
    std::vector<double> siemens(array.taxel_count(), 1e-5);
    for (std::size_t press = 0; press < 1 + random.below(3); ++press) {
      const std::size_t height = 1 + random.below(10);
      const std::size_t width = 1 + random.below(10);
      const std::size_t row = random.below(11 - height);
      const std::size_t col = random.below(11 - width);
      for (std::size_t k = 0; k < height * width; ++k) {
        siemens[array.index(row + k / width, col + k % width)] = 1.0 / random.uniform(60.0, 80.0);
      }
    }
    Checked checked(array);
    learn::simulation::ReadoutCircuit::create(array).value().ratios(siemens, checked.ratio);
    EXPECT_EQ(checked.invalid(), 0U);
  }
}

TEST(Compensator, solves_a_hard_frame_after_easy_ones) {
  constexpr std::uint64_t kSeed = 5;
  Random random(kSeed);
  ArrayDescription array = support::reference_array(12, 10);
  std::fill(array.readout.drive_ohm.begin(), array.readout.drive_ohm.end(), 100.0);
  std::fill(array.readout.load_ohm.begin(), array.readout.load_ohm.end(), 1500.0);
  auto circuit = learn::simulation::ReadoutCircuit::create(array).value();
  auto compensator = Compensator::create(array).value();
  ConditionedFrame frame;
  ConductanceFrame conductance;
  frame.sigma_ratio = 1.0 / 4095.0;
  frame.ratio.resize(array.taxel_count());
  frame.taxels.resize(array.taxel_count());
  std::vector<double> siemens(array.taxel_count(), 1e-5);
  for (int number = 0; number < 80; ++number) {
    for (std::size_t row = 2; row < 10 && number >= 50; ++row) {
      for (std::size_t col = 1; col < 9; ++col) siemens[array.index(row, col)] = 1.0 / random.uniform(270.0, 390.0);
    }
    circuit.ratios(siemens, frame.ratio);
    frame.time += std::chrono::milliseconds(10);
    compensator.process(frame, conductance);
    ASSERT_FALSE(has(conductance.status, FrameStatus::not_converged)) << "frame " << number << ", seed " << kSeed;
  }
}

TEST(PossibleReadings, the_largest_of_each_line_with_little_left_is_taken_or_the_largest_of_all) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  checked.ratio[array.index(1, 3)] = 0.7;
  checked.ratio[array.index(2, 3)] = 0.1;
  checked.ratio[array.index(4, 8)] = 0.75;
  checked.ratio[array.index(5, 9)] = 0.3;
  checked.possible.take_largest(checked.ratio, checked.taxels);
  EXPECT_EQ(std::count(checked.taxels.begin(), checked.taxels.end(), TaxelStatus::invalid), 2);
  checked.possible.take_largest(checked.ratio, checked.taxels);
  EXPECT_EQ(std::count(checked.taxels.begin(), checked.taxels.end(), TaxelStatus::invalid), 3);
  EXPECT_EQ(checked.taxels[array.index(5, 9)], TaxelStatus::invalid);
}

TEST(PossibleReadings, full_lines_are_taken_whole_and_the_others_not) {
  const ArrayDescription array = support::reference_circuit();
  Checked checked(array);
  checked.ratio[array.index(1, 3)] = 0.7;
  checked.ratio[array.index(5, 9)] = 0.3;
  EXPECT_TRUE(checked.possible.take_full_lines(checked.ratio, checked.taxels));
  EXPECT_EQ(std::count(checked.taxels.begin(), checked.taxels.end(), TaxelStatus::invalid),
            static_cast<std::ptrdiff_t>(array.rows));
  EXPECT_EQ(checked.taxels[array.index(1, 9)], TaxelStatus::ok);
  EXPECT_FALSE(checked.possible.take_full_lines(checked.ratio, checked.taxels));
}

}  // namespace
}  // namespace dermis::touch::compensation
