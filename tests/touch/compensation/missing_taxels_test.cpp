// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/missing_taxels.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kUnloaded = 1e-5;  // [S]
constexpr double kPressed = 2e-3;   // [S]
constexpr std::size_t kRow = 4;
constexpr std::size_t kCol = 6;

/// All taxels are unloaded and solved as if the missing one were `taken`, where it is kPressed.
std::vector<double> solved_with(const ArrayDescription& array, double taken) {
  const double load = 1.0 / array.readout.load_ohm[kCol];
  std::vector<double> siemens(array.taxel_count(), kUnloaded);
  for (std::size_t row = 0; row < array.rows; ++row) {
    siemens[array.index(row, kCol)] = kUnloaded * (load + taken) / (load + kPressed);
  }
  siemens[array.index(kRow, kCol)] = taken;
  return siemens;
}

/// All taxels are read; a fault hides these.
void hide(MissingTaxels& taxels, std::size_t count, std::initializer_list<std::size_t> hidden_taxels) {
  std::vector<std::uint8_t> hidden(count);
  for (const std::size_t taxel : hidden_taxels) hidden[taxel] = 1;
  taxels.mark(std::vector<TaxelStatus>(count), hidden);
}

TEST(MissingTaxels, of_the_sheet_are_those_that_are_hidden_or_not_read) {
  ArrayDescription array = support::reference_circuit();
  array.absent = {3};
  MissingTaxels taxels(array, {});
  std::vector<TaxelStatus> status(array.taxel_count());
  std::vector<std::uint8_t> hidden(array.taxel_count());
  status[3] = TaxelStatus::invalid;
  EXPECT_FALSE(taxels.mark(status, hidden));
  EXPECT_FALSE(taxels.any());
  hidden[5] = 1;
  EXPECT_FALSE(taxels.mark(status, hidden));
  EXPECT_TRUE(taxels.any());
  status[7] = TaxelStatus::invalid;
  EXPECT_TRUE(taxels.mark(status, hidden));
  for (std::size_t taxel = 0; taxel < status.size(); ++taxel) {
    EXPECT_EQ(taxels.is_missing(taxel), taxel == 5 || taxel == 7) << taxel;
  }
}

TEST(MissingTaxels, the_unloaded_others_of_the_column_tell_what_presses_where_nothing_is_read) {
  const ArrayDescription array = support::reference_circuit();
  const std::vector<double> unloaded(array.taxel_count(), kUnloaded);
  const std::size_t taxel = array.index(kRow, kCol);
  MissingTaxels taxels(array, {unloaded, unloaded});
  hide(taxels, array.taxel_count(), {taxel});
  for (const double taken : {0.3 * kPressed, 3.0 * kPressed}) {
    std::vector<double> siemens = solved_with(array, taken);
    siemens[taxel - 1] = siemens[taxel + 1] = 0.5 * kPressed;  // the neighbours are pressed, too
    taxels.improve(siemens);
    EXPECT_NEAR(siemens[taxel], kPressed, 0.1 * kPressed) << taken;
    EXPECT_LT(taxels.doubt(taxel), 0.15);
  }
}

TEST(MissingTaxels, where_rows_float_only_the_neighbours_tell) {
  ArrayDescription array = support::reference_circuit();
  array.readout.idle_rows = IdleRows::floating;
  const std::vector<double> unloaded(array.taxel_count(), kUnloaded);
  const std::size_t taxel = array.index(kRow, kCol);
  MissingTaxels taxels(array, {unloaded, unloaded});
  hide(taxels, array.taxel_count(), {taxel});
  std::vector<double> siemens = solved_with(array, 0.3 * kPressed);
  std::vector<double> from_neighbours = siemens;
  taxels.estimate(from_neighbours);
  taxels.improve(siemens);
  EXPECT_EQ(siemens, from_neighbours);
}

class HeldTaxel : public testing::Test {
 protected:
  HeldTaxel() {
    siemens_[0] = kPressed;
    taxels_.remember(siemens_);
    hide(taxels_, array_.taxel_count(), {0});
  }
  void start_frame(Nanos later) { taxels_.start_frame(time_ += later); }

  ArrayDescription array_ = support::reference_circuit();
  std::vector<double> siemens_ = std::vector<double>(array_.taxel_count(), kUnloaded);
  MissingTaxels taxels_{array_, {}};
  Nanos time_{};
};

TEST_F(HeldTaxel, stays_what_it_was_for_three_frames) {
  for (int frame = 0; frame < 3; ++frame) {
    start_frame(std::chrono::milliseconds(10));
    EXPECT_EQ(taxels_.held(0), kPressed) << frame;
  }
  start_frame(std::chrono::milliseconds(10));
  EXPECT_FALSE(taxels_.held(0));
}

TEST_F(HeldTaxel, is_not_held_after_a_gap_or_a_fault) {
  start_frame(std::chrono::milliseconds(60));
  EXPECT_FALSE(taxels_.held(0));
  hide(taxels_, array_.taxel_count(), {});
  taxels_.remember(siemens_);
  start_frame(std::chrono::milliseconds(10));
  EXPECT_TRUE(taxels_.held(0));
  taxels_.forget(0);
  EXPECT_FALSE(taxels_.held(0));
}

}  // namespace
}  // namespace dermis::touch::compensation
