// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Arrays with a film over their lines, against nodal equations that are written down and solved here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/dense_solve.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kTypicalSiemens = 1e-3;  // at 10 N
constexpr double kUnloadedSiemens = 4e-6;

struct FilmCase {
  std::size_t rows;
  std::size_t cols;
  double drive_ohm;
  double load_ohm;
  Film film;
  Circuit circuit = Circuit::divider;
};

ArrayDescription array_of(const FilmCase& of) {
  ArrayDescription array;
  array.rows = of.rows;
  array.cols = of.cols;
  array.readout.circuit = of.circuit;
  array.readout.drive_ohm.assign(of.rows, of.drive_ohm);
  array.readout.load_ohm.assign(of.cols, of.load_ohm);
  array.readout.film = of.film;
  return array;
}

/// Rows driven in turn, the others grounded; columns in their loads, or at 0 V.
std::vector<double> readings(const FilmCase& of, const std::vector<double>& siemens, const FilmConductances& film) {
  const std::size_t nodes = of.rows + of.cols;
  std::vector<double> matrix(nodes * nodes);
  const auto connect = [&](std::size_t a, std::size_t b, double g) {
    matrix[a * nodes + a] += g;
    matrix[b * nodes + b] += g;
    matrix[a * nodes + b] -= g;
    matrix[b * nodes + a] -= g;
  };
  const bool at_ground = of.circuit == Circuit::transimpedance;
  const double driver = 1.0 / std::max(of.drive_ohm, 1e-7);
  for (std::size_t row = 0; row < of.rows; ++row) {
    matrix[row * nodes + row] += driver;
    for (std::size_t col = 0; col < of.cols; ++col) connect(row, of.rows + col, siemens[row * of.cols + col]);
    if (row + 1 < of.rows) connect(row, row + 1, film.between_rows[row]);
  }
  for (std::size_t col = 0; col < of.cols; ++col) {
    const std::size_t node = of.rows + col;
    matrix[node * nodes + node] += at_ground ? 1e9 : 1.0 / of.load_ohm;
    if (col + 1 < of.cols) connect(node, node + 1, film.between_cols[col]);
  }
  std::vector<double> right(nodes * of.rows);
  for (std::size_t row = 0; row < of.rows; ++row) right[row * of.rows + row] = driver;
  const std::vector<double> volts = support::solve(matrix, right, nodes);
  std::vector<double> ratio(siemens.size());
  for (std::size_t row = 0; row < of.rows; ++row) {
    for (std::size_t col = 0; col < of.cols; ++col) {
      double current = volts[(of.rows + col) * of.rows + row];
      if (at_ground) {
        current = 0.0;
        for (std::size_t k = 0; k < of.rows; ++k) current += volts[k * of.rows + row] * siemens[k * of.cols + col];
        current *= of.load_ohm;
      }
      ratio[row * of.cols + col] = current;
    }
  }
  return ratio;
}

/// Touches that a law of 10 N at 1 mS turns into conductances.
std::vector<double> random_newtons(std::size_t taxels, Random& random) {
  std::vector<double> newtons(taxels);
  for (double& force : newtons) force = random.uniform() < 0.2 ? 30.0 * random.uniform() : 0.0;
  return newtons;
}

std::vector<double> siemens_of(const std::vector<double>& newtons) {
  std::vector<double> siemens;
  for (const double force : newtons) siemens.push_back(kUnloadedSiemens + 0.1 * kTypicalSiemens * force);
  return siemens;
}

class FilmOverLines : public testing::TestWithParam<FilmCase> {
 protected:
  ArrayDescription array_ = array_of(GetParam());
  FilmConductances film_{array_.rows, array_.cols};
  std::vector<double> typical_ = std::vector<double>(array_.taxel_count(), kUnloadedSiemens + kTypicalSiemens);
  std::vector<double> unloaded_ = std::vector<double>(array_.taxel_count(), kUnloadedSiemens);
  std::vector<LoadPoint> loads_{{1.0, 10.0}, {10.0, 100.0}};
};

TEST_P(FilmOverLines, is_inverted_to_the_conductances_that_were_there_where_its_loads_are_known) {
  Random random(7);
  auto inversion = make_crosstalk_inversion(array_, {.tolerance_ratio = 1e-13});
  ASSERT_TRUE(inversion);
  for (int frame = 0; frame < 20; ++frame) {
    const std::vector<double> newtons = random_newtons(array_.taxel_count(), random);
    const std::vector<double> siemens = siemens_of(newtons);
    film_.set(*array_.readout.film, newtons);
    (*inversion)->hold_film(film_);
    std::vector<double> found(siemens.size());
    EXPECT_TRUE((*inversion)->invert(readings(GetParam(), siemens, film_), found).solved);
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], siemens[k], 1e-8) << frame << " " << k;
  }
}

TEST_P(FilmOverLines, follows_the_loads_that_the_conductances_tell) {
  Random random(8);
  auto inversion =
      make_crosstalk_inversion(array_, {.tolerance_ratio = {}, .references = {typical_, unloaded_, loads_}});
  ASSERT_TRUE(inversion);
  for (int frame = 0; frame < 20; ++frame) {
    const std::vector<double> newtons = random_newtons(array_.taxel_count(), random);
    const std::vector<double> siemens = siemens_of(newtons);
    film_.set(*array_.readout.film, newtons);
    std::vector<double> found(siemens.size());
    EXPECT_TRUE((*inversion)->invert(readings(GetParam(), siemens, film_), found).solved);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k], siemens[k], 0.01 * siemens[k] + 5e-6) << frame << " " << k;
    }
  }
}

TEST_P(FilmOverLines, keeps_a_taxel_without_a_reading_and_solves_the_others) {
  Random random(9);
  auto inversion = make_crosstalk_inversion(array_, {.tolerance_ratio = 1e-13});
  ASSERT_TRUE(inversion);
  const std::vector<double> newtons = random_newtons(array_.taxel_count(), random);
  const std::vector<double> siemens = siemens_of(newtons);
  film_.set(*array_.readout.film, newtons);
  (*inversion)->hold_film(film_);
  std::vector<double> ratio = readings(GetParam(), siemens, film_);
  std::vector<double> found(siemens.size());
  for (const std::size_t taxel : {std::size_t{1}, array_.taxel_count() - 1}) {
    ratio[taxel] = std::nan("");
    found[taxel] = siemens[taxel];
  }
  EXPECT_TRUE((*inversion)->invert(ratio, found).solved);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], siemens[k], 1e-8) << k;
}

TEST_P(FilmOverLines, of_rest_is_found_without_an_allocation) {
  auto inversion =
      make_crosstalk_inversion(array_, {.tolerance_ratio = {}, .references = {typical_, unloaded_, loads_}});
  ASSERT_TRUE(inversion);
  const std::vector<double> siemens(array_.taxel_count(), kUnloadedSiemens);
  film_.set(*array_.readout.film, std::vector<double>(siemens.size()));
  const std::vector<double> ratio = readings(GetParam(), siemens, film_);
  std::vector<double> found(siemens.size());
  const support::AllocationGuard guard;
  const bool solved = (*inversion)->invert(ratio, found).solved;
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(solved);
  for (const double g : found) EXPECT_NEAR(g, kUnloadedSiemens, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(
    grounded_rows, FilmOverLines,
    testing::Values(FilmCase{10, 10, 30.0, 220.0, {50e3, 2e3, 20.0}}, FilmCase{10, 10, 30.0, 220.0, {5e3, 5e3, 20.0}},
                    FilmCase{16, 16, 30.0, 220.0, {50e3, 2e3, 20.0}}, FilmCase{5, 12, 0.0, 1000.0, {50e3, 2e3, 20.0}},
                    FilmCase{12, 5, 100.0, 100.0, {5e3, 1e3, 20.0}}, FilmCase{1, 6, 30.0, 220.0, {5e3, 1e3, 20.0}},
                    FilmCase{6, 1, 30.0, 220.0, {5e3, 1e3, 20.0}}, FilmCase{32, 32, 10.0, 100.0, {50e3, 2e3, 20.0}}));

INSTANTIATE_TEST_SUITE_P(virtual_ground, FilmOverLines,
                         testing::Values(FilmCase{10, 10, 30.0, 150.0, {50e3, 2e3, 20.0}, Circuit::transimpedance},
                                         FilmCase{10, 10, 30.0, 150.0, {5e3, 5e3, 20.0}, Circuit::transimpedance},
                                         FilmCase{7, 12, 100.0, 150.0, {5e3, 1e3, 20.0}, Circuit::transimpedance}));

}  // namespace
}  // namespace dermis::touch::compensation
