// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/film_fit.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "support/reference_array.hpp"
#include "support/sheet_presses.hpp"

namespace dermis::learn::calibration {
namespace {

ArrayDescription sheet(std::optional<Film> film, std::optional<Cover> cover = std::nullopt) {
  ArrayDescription array = support::reference_array(8, 8);
  array.row_pitch_m = array.col_pitch_m = 0.010;
  array.readout.film = film;
  array.cover = std::move(cover);
  return array;
}

FilmFit fit(const ArrayDescription& truth, std::uint64_t seed, bool is_cover_told = true) {
  ArrayDescription described = truth;
  described.readout.film.reset();
  if (!is_cover_told) described.cover.reset();
  const support::SheetPresses presses(truth, seed);
  return fit_film(described, presses.frames, presses.loads, Nanos{0});
}

TEST(FilmFit, finds_a_film_that_loads_do_not_change) {
  const FilmFit found = fit(sheet(Film{5e3, 5e3}), 1);
  ASSERT_TRUE(found.film);
  EXPECT_NEAR(found.film->unloaded_ohm, 5e3, 0.1 * 5e3);
  EXPECT_NE(found.sentence.find("your sheet is one film"), std::string::npos) << found.sentence;
}

TEST(FilmFit, finds_a_film_that_conducts_more_under_load) {
  const FilmFit found = fit(sheet(Film{50e3, 2e3, 20.0}), 2);
  ASSERT_TRUE(found.film);
  EXPECT_NEAR(found.film->loaded_ohm, 2e3, 0.05 * 2e3);
  EXPECT_NE(found.sentence.find("where 20 N press on both"), std::string::npos) << found.sentence;
}

TEST(FilmFit, finds_a_film_below_a_cover) {
  const FilmFit found = fit(sheet(Film{20e3, 2e3, 20.0}, Cover{0.004, {}}), 3);
  ASSERT_TRUE(found.film);
  EXPECT_NEAR(found.film->loaded_ohm, 2e3, 0.1 * 2e3);
}

TEST(FilmFit, finds_a_strong_film_over_floating_rows) {
  ArrayDescription array = sheet(Film{6e3, 1.7e3, 20.0});
  array.readout.idle_rows = IdleRows::floating;
  const FilmFit found = fit(array, 20);
  ASSERT_TRUE(found.film);
  EXPECT_NEAR(found.film->unloaded_ohm, 6e3, 0.1 * 6e3);
  EXPECT_NEAR(found.film->loaded_ohm, 1.7e3, 0.1 * 1.7e3);
  EXPECT_FALSE(found.cover);
}

TEST(FilmFit, tells_a_film_and_its_cover_apart_over_floating_rows) {
  ArrayDescription array = sheet(Film{70e3, 6e3, 20.0}, Cover{0.006, {}});
  array.readout.idle_rows = IdleRows::floating;
  const FilmFit found = fit(array, 21, false);
  ASSERT_TRUE(found.film);
  ASSERT_TRUE(found.cover);
  EXPECT_NEAR(found.cover->spread_m, 0.006, 0.0003);
}

TEST(FilmFit, finds_none_in_separate_taxels_over_a_virtual_ground) {
  ArrayDescription array = sheet(std::nullopt);
  array.readout.circuit = Circuit::transimpedance;
  for (std::uint64_t seed = 22; seed < 25; ++seed) EXPECT_FALSE(fit(array, seed).film) << seed;
}

TEST(FilmFit, finds_none_in_a_sheet_of_separate_taxels) {
  for (std::uint64_t seed = 4; seed < 10; ++seed) EXPECT_FALSE(fit(sheet(std::nullopt), seed).film) << seed;
}

TEST(FilmFit, finds_none_in_a_sheet_with_a_cover) {
  for (std::uint64_t seed = 10; seed < 14; ++seed) {
    EXPECT_FALSE(fit(sheet(std::nullopt, Cover{0.006, {}}), seed).film) << seed;
  }
}

TEST(FilmFit, needs_presses_of_single_taxels) {
  const FilmFit found = fit_film(sheet(std::nullopt), {}, {}, Nanos{0});
  EXPECT_FALSE(found.film);
  EXPECT_NE(found.sentence.find("press between r4c4 and r4c5"), std::string::npos) << found.sentence;
}

}  // namespace
}  // namespace dermis::learn::calibration
