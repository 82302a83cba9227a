// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis {
namespace {

const Film kFilm{50e3, 2e3, 20.0};

TEST(Film, is_between_lines_as_an_ohmmeter_shows_it_with_nothing_on_the_sheet) {
  FilmConductances film(3, 4);
  film.set(kFilm, std::vector<double>(12));
  for (const double siemens : film.between_rows) EXPECT_DOUBLE_EQ(siemens, 1.0 / 50e3);
  for (const double siemens : film.between_cols) EXPECT_DOUBLE_EQ(siemens, 1.0 / 50e3);
}

TEST(Film, has_the_loaded_resistance_where_the_force_is_on_one_pair_of_taxels) {
  FilmConductances film(3, 4);
  std::vector<double> newtons(12);
  newtons[5] = newtons[6] = 20.0;  // r1c1, r1c2
  film.set(kFilm, newtons);
  EXPECT_NEAR(1.0 / film.between_cols[1], 2e3, 1e-9);
  const double half = 1.0 / 50e3 + (1.0 / 2e3 - 1.0 / 50e3) * std::pow(0.5, 0.9);  // one of a pair
  EXPECT_NEAR(film.between_cols[0], half, 1e-15);
  EXPECT_NEAR(film.between_rows[0], 1.0 / 50e3 + 2.0 * (half - 1.0 / 50e3), 1e-15);
}

TEST(Film, conducts_no_more_beyond_that_force) {
  EXPECT_DOUBLE_EQ(kFilm.rise(20.0, 20.0), kFilm.rise(60.0, 60.0));
}

TEST(Film, takes_forces_below_zero_and_unknown_ones_for_none) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DOUBLE_EQ(kFilm.rise(-5.0, unknown), 0.0);
  EXPECT_DOUBLE_EQ(kFilm.rise(10.0, unknown), kFilm.rise(10.0, 0.0));
}

TEST(Film, that_does_not_depend_on_loads_is_constant) {
  EXPECT_TRUE((Film{5e3, 5e3}).is_constant());
  EXPECT_DOUBLE_EQ((Film{5e3, 5e3}).rise(10.0, 10.0), 0.0);
  EXPECT_FALSE(kFilm.is_constant());
}

TEST(Film, is_unknown_as_long_as_a_resistance_is_to_be_fitted) {
  EXPECT_TRUE((Film{kFitOhm, 2e3, 20.0}).is_unknown());
  EXPECT_FALSE(kFilm.is_unknown());
}

}  // namespace
}  // namespace dermis
