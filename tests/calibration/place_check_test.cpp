// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <vector>

#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {
namespace {

constexpr std::size_t kSide = 3;

ArrayDescription bare_array() {
  ArrayDescription array;
  array.rows = kSide;
  array.cols = kSide;
  array.readout.circuit = Circuit::none;
  array.readout.adc_bits = 10;
  return array;
}

struct Presses {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

/// Every taxel is pressed once, after a frame without a load. `exchanged` of the loads, the first ones, name the column
/// as row.
Presses presses(std::size_t exchanged) {
  Presses presses;
  const auto add = [&](const TaxelRegion& where, double newtons) {
    RawFrame& frame = presses.frames.emplace_back();
    frame.time = std::chrono::milliseconds(10 * presses.frames.size());
    frame.counts.assign(kSide * kSide, 20.0F);
    presses.loads.push_back({presses.frames.size() - 1, LoadKind::force, where, newtons});
  };
  for (std::size_t taxel = 0; taxel < kSide * kSide; ++taxel) {
    add({0, 0, kSide - 1, kSide - 1}, 0.0);
    const std::size_t row = taxel / kSide;
    const std::size_t col = taxel % kSide;
    const bool is_exchanged = taxel < exchanged;
    add(is_exchanged ? TaxelRegion{col, row, col, row} : TaxelRegion{row, col, row, col}, 5.0);
    presses.frames.back().counts[taxel] = 500.0F;
  }
  return presses;
}

TEST(PlaceCheck, refuses_loads_that_exchange_rows_and_columns) {
  const auto [frames, loads] = presses(kSide * kSide);
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(database.error().message,
            "the loads exchange rows and columns: r1c0 answers where they name r0c1, as in 6 of 6 taxels that tell; "
            "exchange them in loads.csv, or turn the frames (transpose=1)");
}

TEST(PlaceCheck, takes_loads_whose_taxels_answer) {
  const auto [frames, loads] = presses(0);
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

TEST(PlaceCheck, takes_loads_of_which_a_few_are_wrong) {
  const auto [frames, loads] = presses(2);
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

TEST(PlaceCheck, asks_more_than_two_taxels) {
  auto [frames, loads] = presses(kSide * kSide);
  frames.resize(6);
  loads.resize(6);  // r0c0, r0c1 and r0c2
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

}  // namespace
}  // namespace dermis::calibration
