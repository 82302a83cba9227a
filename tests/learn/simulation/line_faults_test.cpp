// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/line_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dermis/bytes/files/config_table.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::simulation {
namespace {

ArrayDescription make_array(Circuit circuit, IdleRows idle_rows = IdleRows::grounded, std::size_t rows = 6,
                            std::size_t cols = 5) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.readout.circuit = circuit;
  array.readout.idle_rows = idle_rows;
  Random random(rows * 31 + cols);
  for (std::size_t k = 0; k < array.driven_lines(); ++k) array.readout.drive_ohm.push_back(random.uniform(5.0, 50.0));
  for (std::size_t k = 0; k < array.sensed_lines(); ++k) array.readout.load_ohm.push_back(random.uniform(100.0, 500.0));
  return array;
}

std::vector<double> random_siemens(const ArrayDescription& array, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> siemens(array.taxel_count());
  for (double& g : siemens) g = 1.0 / random.log_uniform(500.0, 1e5);
  return siemens;
}

std::vector<double> read(const ArrayDescription& array, const std::vector<double>& siemens, const LineFaults& faults,
                         std::size_t frame = 0) {
  std::vector<double> ratio(siemens.size());
  FaultyCircuit::create(array, faults).value().ratios(siemens, frame, ratio);
  return ratio;
}

std::vector<double> read_healthy(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  ReadoutCircuit::create(array).value().ratios(siemens, ratio);
  return ratio;
}

void expect_near(const std::vector<double>& actual, const std::vector<double>& expected, double relative) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t k = 0; k < actual.size(); ++k) {
    EXPECT_NEAR(actual[k], expected[k], relative * std::abs(expected[k]) + 1e-9) << "taxel " << k;
  }
}

TEST(LineFaults, without_a_fault_the_circuit_reads_as_it_should) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (const IdleRows idle : {IdleRows::grounded, IdleRows::floating}) {
      const ArrayDescription array = make_array(circuit, idle);
      const auto siemens = random_siemens(array, 1);
      expect_near(read(array, siemens, {}), read_healthy(array, siemens), 1e-9);
    }
  }
}

/// The limits of a healthy circuit: an open row has a driver of infinite resistance, a row that is shorted to 0 V while
/// others are driven has one of 0 ohm, an open column a load of infinite resistance.
TEST(LineFaults, open_lines_are_the_limit_of_a_large_resistance) {
  for (const IdleRows idle : {IdleRows::grounded, IdleRows::floating}) {
    ArrayDescription array = make_array(Circuit::divider, idle);
    const auto siemens = random_siemens(array, 2);
    LineFaults faults;
    faults.rows.open = {2};
    const auto open_row = read(array, siemens, faults);
    ArrayDescription limit = array;
    limit.readout.drive_ohm[2] = 1e12;
    expect_near(open_row, read_healthy(limit, siemens), 1e-6);

    faults = {};
    faults.columns.open = {3};
    auto open_column = read(array, siemens, faults);
    limit = array;
    limit.readout.load_ohm[3] = 1e12;
    auto limit_ratio = read_healthy(limit, siemens);
    for (std::size_t row = 0; row < array.rows; ++row) {
      EXPECT_EQ(open_column[array.index(row, 3)], 0.0) << "nothing reaches the ADC";
      limit_ratio[array.index(row, 3)] = 0.0;
    }
    expect_near(open_column, limit_ratio, 1e-6);
  }
}

TEST(LineFaults, grounded_row_is_a_driver_that_always_gives_nothing) {
  const ArrayDescription array = make_array(Circuit::divider);
  const auto siemens = random_siemens(array, 3);
  LineFaults faults;
  faults.rows.grounded = {1};
  const auto ratio = read(array, siemens, faults);
  ArrayDescription limit = array;
  limit.readout.drive_ohm[1] = 0.0;
  auto expected = read_healthy(limit, siemens);
  for (std::size_t col = 0; col < array.cols; ++col) expected[array.index(1, col)] = 0.0;
  expect_near(ratio, expected, 1e-9);
}

/// Superposition: every scan also holds what the supplied row contributes, which is what its own scan reads.
TEST(LineFaults, supplied_row_adds_its_own_reading_to_every_scan) {
  const ArrayDescription array = make_array(Circuit::divider);
  const auto siemens = random_siemens(array, 4);
  LineFaults faults;
  faults.rows.supplied = {4};
  const auto ratio = read(array, siemens, faults);
  ArrayDescription ideal = array;
  ideal.readout.drive_ohm[4] = 0.0;
  auto expected = read_healthy(ideal, siemens);
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      if (row != 4) expected[array.index(row, col)] += expected[array.index(4, col)];
    }
  }
  expect_near(ratio, expected, 1e-9);
}

/// Two columns that are one node are one column: the sum of their taxels, their loads in parallel.
TEST(LineFaults, shorted_columns_are_one_column) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    const ArrayDescription array = make_array(circuit);
    const auto siemens = random_siemens(array, 5);
    LineFaults faults;
    faults.columns.shorted = {1};
    const auto ratio = read(array, siemens, faults);

    ArrayDescription merged = array;
    merged.cols = array.cols - 1;
    auto& load = merged.readout.load_ohm;
    load[1] = 1.0 / (1.0 / load[1] + 1.0 / load[2]);
    load.erase(load.begin() + 2);
    std::vector<double> sums;
    for (std::size_t row = 0; row < array.rows; ++row) {
      for (std::size_t col = 0; col < array.cols; ++col) {
        if (col == 2) continue;
        const double other = col == 1 ? siemens[array.index(row, 2)] : 0.0;
        sums.push_back(siemens[array.index(row, col)] + other);
      }
    }
    const auto expected = read_healthy(merged, sums);
    for (std::size_t row = 0; row < array.rows; ++row) {
      for (std::size_t col = 0; col < array.cols; ++col) {
        const std::size_t place = row * merged.cols + (col < 2 ? col : col - 1);
        EXPECT_NEAR(ratio[array.index(row, col)], expected[place], 1e-9 * expected[place]) << row << ' ' << col;
      }
    }
  }
}

/// While one of two joined rows is driven its driver works against that of the other, which holds 0 V.
TEST(LineFaults, shorted_rows_stand_between_their_drivers) {
  const ArrayDescription array = make_array(Circuit::divider);
  const auto siemens = random_siemens(array, 6);
  LineFaults faults;
  faults.rows.shorted = {2};
  const auto ratio = read(array, siemens, faults);

  ArrayDescription merged = array;
  merged.rows = array.rows - 1;
  auto& drive = merged.readout.drive_ohm;
  const double first = 1.0 / drive[2];
  const double second = 1.0 / drive[3];
  drive[2] = 1.0 / (first + second);
  drive.erase(drive.begin() + 3);
  std::vector<double> sums = siemens;
  for (std::size_t col = 0; col < array.cols; ++col) sums[array.index(2, col)] += siemens[array.index(3, col)];
  sums.erase(sums.begin() + static_cast<std::ptrdiff_t>(3 * array.cols),
             sums.begin() + static_cast<std::ptrdiff_t>(4 * array.cols));
  const auto expected = read_healthy(merged, sums);
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      const double share = row == 2 ? first / (first + second) : row == 3 ? second / (first + second) : 1.0;
      const double wanted = share * expected[(row < 3 ? row : row - 1) * array.cols + col];
      EXPECT_NEAR(ratio[array.index(row, col)], wanted, 1e-9 * wanted) << row << ' ' << col;
    }
  }
}

std::vector<ArrayDescription> arrays_of_every_circuit() {
  std::vector<ArrayDescription> arrays = {
      make_array(Circuit::divider), make_array(Circuit::divider, IdleRows::floating),
      make_array(Circuit::transimpedance), make_array(Circuit::transimpedance, IdleRows::floating),
      make_array(Circuit::flexitac)};
  arrays.push_back(make_array(Circuit::divider));
  arrays.back().readout.idle_columns = IdleColumns::floating;
  return arrays;
}

TEST(LineFaults, a_shorted_crossing_is_the_limit_of_a_taxel_of_0_ohm) {
  for (const ArrayDescription& array : arrays_of_every_circuit()) {
    SCOPED_TRACE(testing::Message() << to_string(array.readout.circuit));
    auto siemens = random_siemens(array, 11);
    LineFaults faults;
    faults.shorted_taxels = {"r2c3"};
    const auto ratio = read(array, siemens, faults);
    siemens[array.index(2, 3)] = 1e8;
    expect_near(ratio, read_healthy(array, siemens), 1e-5);
  }
}

TEST(LineFaults, every_circuit_reads_finite_numbers_with_every_fault) {
  std::vector<ArrayDescription> arrays = arrays_of_every_circuit();
  arrays.push_back(make_array(Circuit::divider));
  arrays.back().readout.drive_ohm.assign(arrays.back().rows, 0.0);
  std::vector<LineFaults> all(12);
  all[0].rows.open = {0, 5};
  all[1].columns.open = {0, 4};
  all[2].rows.grounded = {1};
  all[3].columns.grounded = {1};
  all[4].rows.supplied = {2};
  all[5].columns.supplied = {2};
  all[6].rows.shorted = {3, 4};
  all[7].columns.shorted = {3};
  all[8].dead_taxels = {"r0c0", "r5c4"};
  all[9].drifting_rows = {1};
  all[9].drift_ohm = 100.0;
  all[10].rows.open = {0, 1, 2, 3, 4, 5};
  all[10].columns.open = {0, 1, 2, 3, 4};
  all[11].shorted_taxels = {"r0c0", "r0c2", "r3c2", "r5c4"};
  for (std::size_t circuit = 0; circuit < arrays.size(); ++circuit) {
    for (std::size_t fault = 0; fault < all.size(); ++fault) {
      for (const double value : read(arrays[circuit], random_siemens(arrays[circuit], 7), all[fault])) {
        ASSERT_TRUE(std::isfinite(value)) << "circuit " << circuit << ", fault " << fault;
      }
    }
  }
}

TEST(LineFaults, drift_grows_until_its_end) {
  const ArrayDescription array = make_array(Circuit::divider);
  const auto siemens = random_siemens(array, 8);
  LineFaults faults;
  faults.drifting_rows = {2};
  faults.drift_ohm = 60.0;
  faults.drift_frames = 10;
  faults.from_frame = 5;
  for (const auto& [frame, added] : {std::pair{4UL, 0.0}, std::pair{10UL, 30.0}, std::pair{40UL, 60.0}}) {
    ArrayDescription drifted = array;
    drifted.readout.drive_ohm[2] += added;
    expect_near(read(array, siemens, faults, frame), read_healthy(drifted, siemens), 1e-9);
  }
}

TEST(LineFaults, stuck_and_dead_taxels) {
  const ArrayDescription array = make_array(Circuit::divider);
  auto siemens = random_siemens(array, 9);
  LineFaults faults;
  faults.dead_taxels = {"r1c2"};
  faults.stuck_taxels = {"r3c4"};
  faults.stuck_ratio = 0.5;
  const auto ratio = read(array, siemens, faults);
  siemens[array.index(1, 2)] = 0.0;
  expect_near(ratio, read_healthy(array, siemens), 1e-9);
  std::vector<float> counts(array.taxel_count(), 7.0F);
  FaultyCircuit::create(array, faults).value().stick(counts);
  EXPECT_EQ(counts[array.index(3, 4)], 2048.0F);
  EXPECT_EQ(counts[array.index(3, 3)], 7.0F);
}

TEST(LineFaults, refuses_lines_that_the_array_does_not_have) {
  const ArrayDescription array = make_array(Circuit::divider);
  LineFaults faults;
  faults.rows.shorted = {5};
  EXPECT_EQ(faults.validate(array).error().message, "faults.shorted_rows: must be below 5, counted from 0");
  faults = {};
  faults.dead_taxels = {"r6c0"};
  EXPECT_EQ(faults.validate(array).error().message, "faults.dead_taxels: the array has no taxel \"r6c0\"");
  faults = {};
  faults.from_frame = 3;
  faults.until_frame = 3;
  EXPECT_EQ(faults.validate(array).error().message, "faults.until_frame: must be above from_frame");
}

TEST(LineFaults, are_read_from_toml) {
  bytes::files::ConfigFile file =
      bytes::files::ConfigFile::parse("[faults]\nopen_rows = [3, 4]\ndead_taxels = [\"r1c1\"]\nfrom_frame = 20\n", "f")
          .value();
  LineFaults faults;
  EXPECT_FALSE(faults.any());
  read_line_faults(file, faults);
  ASSERT_TRUE(file.finish());
  EXPECT_EQ(faults.rows.open, (std::vector<std::size_t>{3, 4}));
  EXPECT_EQ(faults.dead_taxels, std::vector<std::string>{"r1c1"});
  EXPECT_EQ(faults.from_frame, 20U);
  EXPECT_TRUE(faults.any());
}

}  // namespace
}  // namespace dermis::learn::simulation
