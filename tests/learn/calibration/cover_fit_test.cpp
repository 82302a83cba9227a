// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/cover_fit.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/sheet/felt_loads.hpp"
#include "support/reference_array.hpp"
#include "support/sheet_presses.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLines = 8;

CoverFit fit_presses(const ArrayDescription& truth, std::uint64_t seed, const ArrayDescription& described) {
  const support::SheetPresses presses(truth, seed);
  return fit_cover(described, presses.frames, presses.loads, Nanos{0});
}

ArrayDescription sheet(std::optional<Cover> cover) {
  ArrayDescription array = support::reference_array(kLines, kLines);
  array.row_pitch_m = array.col_pitch_m = 0.010;
  array.cover = std::move(cover);
  return array;
}

ArrayDescription without_cover(ArrayDescription array) {
  array.cover.reset();
  return array;
}

TEST(CoverFit, finds_by_how_much_a_cover_spreads) {
  for (const double spread_m : {0.004, 0.006, 0.010}) {
    const ArrayDescription array = sheet(Cover{spread_m, {}});
    const CoverFit fit = fit_presses(array, 3, without_cover(array));
    ASSERT_TRUE(fit.cover) << spread_m;
    ASSERT_TRUE(fit.cover->shares.empty()) << spread_m;
    EXPECT_NEAR(fit.cover->spread_m, spread_m, 0.02 * spread_m);
    EXPECT_NE(fit.sentence.find("your sheet spreads a press over its neighbours"), std::string::npos);
  }
}

TEST(CoverFit, finds_the_shares_of_a_cover_that_is_no_gaussian) {
  std::vector<CoverShare> shares;
  double sum = 0.0;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t col = 0; col < 6; ++col) {
      const double share = std::exp(-std::hypot(static_cast<double>(row), static_cast<double>(col)) / 0.6);
      sum += share * (row > 0 ? 2.0 : 1.0) * (col > 0 ? 2.0 : 1.0);
      shares.push_back({row, col, share});
    }
  }
  for (CoverShare& share : shares) share.share /= sum;
  const ArrayDescription array = sheet(Cover{0.0, shares});
  const CoverFit fit = fit_presses(array, 4, without_cover(array));
  ASSERT_TRUE(fit.cover);
  ArrayDescription found = array;
  found.cover = fit.cover;
  const CoverKernel truth(array);
  const CoverKernel kernel(found);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t col = 0; col < 3; ++col) {
      EXPECT_NEAR(kernel.share(row, col), truth.share(row, col), 0.03 * truth.share(row, col)) << row << " " << col;
    }
  }
}

TEST(CoverFit, finds_none_where_there_is_none) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      ArrayDescription array = sheet({});
      array.readout.circuit = circuit;
      ArrayDescription described = array;
      EXPECT_FALSE(fit_presses(array, seed, described).cover);
      described.readout.drive_ohm.assign(kLines, 60.0);  // and not for wrong drivers
      EXPECT_FALSE(fit_presses(array, seed, described).cover);
    }
  }
}

TEST(CoverFit, knows_the_cover_by_the_corners_where_the_drivers_are_not_known) {
  const ArrayDescription array = sheet(Cover{0.006, {}});
  ArrayDescription described = without_cover(array);
  described.readout.drive_ohm.assign(kLines, kFitOhm);
  const CoverFit fit = fit_presses(array, 5, described);
  ASSERT_TRUE(fit.cover);
  EXPECT_TRUE(fit.is_guessed);
  EXPECT_NEAR(fit.cover->spread_m, 0.006, 0.0006);
}

TEST(CoverFit, knows_it_roughly_by_one_weight_and_asks_for_more) {
  const ArrayDescription array = sheet(Cover{0.006, {}});
  const ArrayDescription described = without_cover(array);
  const support::SheetPresses presses(array, 7, {5.0});
  const CoverFit fit = fit_cover(described, presses.frames, presses.loads, Nanos{0});
  ASSERT_TRUE(fit.cover);
  EXPECT_NE(fit.sentence.find("press some taxels with three"), std::string::npos);
  ArrayDescription found = array;
  found.cover = fit.cover;
  EXPECT_NEAR(CoverKernel(found).share(0, 0), CoverKernel(array).share(0, 0), fit.error);
  const support::SheetPresses bare(described, 8, {5.0});
  EXPECT_FALSE(fit_cover(described, bare.frames, bare.loads, Nanos{0}).cover);
}

TEST(CoverFit, knows_it_by_the_presses_of_two_taxels) {
  const ArrayDescription array = sheet(Cover{0.006, {}});
  const ArrayDescription described = without_cover(array);
  const support::SheetPresses all(array, 9);
  std::vector<Load> loads;
  for (const Load& load : all.loads) {
    const std::size_t col = load.where.first_col;
    if (load.value == 0.0 || (load.where.first_row == 3 && (col == 3 || col == 4))) loads.push_back(load);
  }
  const CoverFit fit = fit_cover(described, all.frames, loads, Nanos{0});
  ASSERT_TRUE(fit.cover);
  ArrayDescription found = array;
  found.cover = fit.cover;
  const CoverKernel truth(array);
  const CoverKernel kernel(found);
  EXPECT_NEAR(kernel.share(0, 1), truth.share(0, 1), 0.02);
  EXPECT_NEAR(kernel.share(1, 0), truth.share(1, 0), 0.02);
  EXPECT_NEAR(kernel.share(1, 1), truth.share(1, 1), 0.02);
}

TEST(CoverFit, says_that_there_is_none_where_it_is_asked_for_one) {
  const ArrayDescription array = sheet({});
  ArrayDescription described = array;
  described.cover = Cover{};
  const CoverFit fit = fit_presses(array, 6, described);
  EXPECT_FALSE(fit.cover);
  EXPECT_NE(fit.sentence.find("no cover"), std::string::npos);
}

TEST(FeltLoads, for_learning_forget_what_is_too_faint_to_be_known) {
  const ArrayDescription array = sheet(Cover{0.005, {}});
  const std::vector<Load> felt = well_felt_loads(
      array, std::vector<Load>{{7, LoadKind::force, {4, 4, 4, 4}, 10.0}, {8, LoadKind::force, {2, 2, 2, 2}, 1.0}});
  std::size_t known = 0;
  std::size_t forgotten = 0;
  for (const Load& load : felt) ++(load.frame == 7 && !std::isnan(load.value) ? known : forgotten);
  EXPECT_EQ(known, 5U);  // the corners feel less than any weight that stood above a taxel
  EXPECT_GT(forgotten, 0U);
}

TEST(FeltLoads, of_a_weight_on_one_taxel_are_the_forces_on_all_that_feel_it) {
  const ArrayDescription array = sheet(Cover{0.005, {}});
  const std::vector<Load> felt = felt_loads(array, std::vector<Load>{{7, LoadKind::force, {4, 4, 4, 4}, 10.0}});
  double sum = 0.0;
  for (const Load& load : felt) {
    EXPECT_EQ(load.frame, 7U);
    EXPECT_EQ(load.where.taxel_count(), 1U);
    sum += load.value;
  }
  EXPECT_NEAR(sum, 10.0, 0.01);
}

TEST(FeltLoads, of_a_weight_on_several_taxels_are_on_all_that_may_feel_it) {
  const ArrayDescription array = sheet(Cover{0.005, {}});
  const std::vector<Load> felt = felt_loads(array, std::vector<Load>{{7, LoadKind::force, {3, 3, 4, 4}, 10.0}});
  ASSERT_EQ(felt.size(), 1U);
  EXPECT_EQ(felt[0].where, (TaxelRegion{0, 0, 7, 7}));
  EXPECT_NEAR(felt[0].value, 10.0, 0.01);
}

TEST(FeltLoads, are_those_of_the_labels_without_a_cover) {
  const std::vector<Load> loads{{7, LoadKind::force, {3, 3, 4, 4}, 10.0}, {8, LoadKind::pressure, {0, 0, 1, 1}, 1e4}};
  const std::vector<Load> felt = felt_loads(sheet({}), loads);
  ASSERT_EQ(felt.size(), 2U);
  EXPECT_EQ(felt[1].value, 1e4);
}

}  // namespace
}  // namespace dermis::learn::calibration
