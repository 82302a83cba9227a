// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/turned_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
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

TEST(TurnedLines, refuses_loads_that_exchange_rows_and_columns) {
  const auto [frames, loads] = presses(kSide * kSide);
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(database.error().message,
            "the loads exchange rows and columns: r1c0 answers where they name r0c1, as in 6 of 6 taxels that tell; "
            "exchange them in loads.csv, or turn the frames (transpose=1)");
}

/// Every taxel is pressed once, and the frames come in reverse order of the rows, the columns or both.
Presses reversed(bool rows, bool cols) {
  Presses turned = presses(0);
  for (RawFrame& frame : turned.frames) {
    const std::vector<float> sent = frame.counts;
    for (std::size_t taxel = 0; taxel < sent.size(); ++taxel) {
      const std::size_t row = rows ? kSide - 1 - taxel / kSide : taxel / kSide;
      const std::size_t col = cols ? kSide - 1 - taxel % kSide : taxel % kSide;
      frame.counts[taxel] = sent[row * kSide + col];
    }
  }
  return turned;
}

std::string error_of(const Presses& recording) {
  const auto database = build_sample_database(bare_array(), recording.frames, recording.loads);
  return database ? std::string() : database.error().message;
}

TEST(TurnedLines, names_lines_that_come_in_reverse_order) {
  EXPECT_EQ(
      error_of(reversed(true, false)),
      "the loads count the rows from the other end than the frames: r2c0 answers where they name r0c0, as in 6 of "
      "6 taxels that tell; turn the frames (flip_rows=1), or count the other way in loads.csv");
  EXPECT_NE(error_of(reversed(false, true)).find("r0c2 answers where they name r0c0"), std::string::npos);
  EXPECT_NE(error_of(reversed(true, true)).find("flip_rows=1&flip_cols=1"), std::string::npos);
}

TEST(TurnedLines, names_reversed_rows_of_simulated_arrays) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ArrayDescription array = reference_array(8, 5);
    Recording recording = record(array, "calibration", seed);
    for (RawFrame& frame : recording.frames) {
      for (std::size_t row = 0; row < 4; ++row) {
        const auto first = frame.counts.begin() + static_cast<std::ptrdiff_t>(5 * row);
        std::swap_ranges(first, first + 5, frame.counts.begin() + static_cast<std::ptrdiff_t>(5 * (7 - row)));
      }
    }
    const auto said = find_turned_lines(array, recording.frames, recording.loads);
    ASSERT_TRUE(said) << seed;
    EXPECT_NE(said->find("turn the frames (flip_rows=1)"), std::string::npos) << *said;
  }
}

TEST(TurnedLines, takes_loads_whose_taxels_answer) {
  const auto [frames, loads] = presses(0);
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

TEST(TurnedLines, takes_loads_of_which_a_few_are_wrong) {
  const auto [frames, loads] = presses(2);
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

TEST(TurnedLines, asks_more_than_two_taxels) {
  auto [frames, loads] = presses(kSide * kSide);
  frames.resize(6);
  loads.resize(6);  // r0c0, r0c1 and r0c2
  EXPECT_TRUE(build_sample_database(bare_array(), frames, loads));
}

}  // namespace
}  // namespace dermis::learn::calibration
