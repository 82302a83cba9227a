// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/film_follower.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

/// Shares of the loaded force, at which the polygon of the film meets its law.
constexpr std::array kFilmCorners{0.0, 0.01, 0.03, 0.08, 0.18, 0.35, 0.6, 1.0};

template <typename Real, std::size_t Corners>
DERMIS_PROCESSOR_CLONES void add_corners(const std::array<double, Corners>& x,
                                         const std::array<double, Corners>& change, const Real* __restrict from,
                                         Real* __restrict to, std::size_t count) {
  std::array<Real, Corners> at{};
  std::array<Real, Corners> slope{};
  std::copy(x.begin(), x.end(), at.begin());
  std::copy(change.begin(), change.end(), slope.begin());
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) {
    Real sum = 0;
    for (std::size_t corner = 0; corner < Corners; ++corner) {
      const Real beyond = from[k] - at[corner];
      sum += slope[corner] * (beyond > 0 ? beyond : 0);
    }
    to[k] = sum;
  }
}

template <typename Real>
DERMIS_PROCESSOR_CLONES void find_shares(const double* __restrict siemens, const double* __restrict unloaded,
                                         const double* __restrict scale, Real* __restrict shares, std::size_t count) {
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) shares[k] = static_cast<Real>((siemens[k] - unloaded[k]) * scale[k]);
}

template <typename Real>
DERMIS_PROCESSOR_CLONES void add_pairs(const Real* __restrict own, const Real* __restrict other, Real* __restrict sums,
                                       std::size_t count) {
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) sums[k] = own[k] + other[k];
}

/// Adds to the sums of the columns.
template <typename Real>
DERMIS_PROCESSOR_CLONES void add_row(const Real* __restrict values, double* __restrict sums, std::size_t count) {
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) sums[k] += static_cast<double>(values[k]);
}

template <typename Real>
DERMIS_PROCESSOR_CLONES double sum_row(const Real* values, std::size_t count) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(values[k]);
  return sum;
}

}  // namespace

FilmFollower::FilmFollower(const ArrayDescription& array, const ReferenceConductances& references)
    : film_(array.readout.film), rows_(array.rows), cols_(array.cols), conductances_(array.rows, array.cols) {
  if (!film_) return;
  for (auto* values : {&single_.newtons, &single_.pairs, &single_.rises}) values->resize(array.taxel_count());
  for (auto* values : {&full_.newtons, &full_.pairs, &full_.rises}) values->resize(array.taxel_count());
  conductances_.set(*film_, std::span<const double>(full_.newtons));
  if (film_->is_constant() || references.loads.empty()) return;
  std::vector<double> shares{0.0};
  std::vector<double> loads{0.0};
  for (const LoadPoint& point : references.loads) {
    shares.push_back(point.share);
    loads.push_back(point.newtons);
  }
  loads_ = polygon_of(shares, loads);
  std::vector<double> pairs;
  std::vector<double> rises;
  for (const double share : kFilmCorners) {
    const double newtons = share * film_->loaded_newtons;
    pairs.push_back(2.0 * newtons);
    rises.push_back(film_->rise(newtons, newtons));
  }
  pairs.push_back(2.0 * pairs.back());
  rises.push_back(rises.back());
  rise_ = polygon_of(pairs, rises);
  follows_ = true;
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    unloaded_.push_back(std::max(references.unloaded[taxel], 0.0));
    const double typical = references.typical[taxel] - unloaded_.back();
    scale_.push_back(typical > 0.0 ? 1.0 / typical : 0.0);
  }
}

/// From the origin on. It goes on as between the last two points.
FilmFollower::Polygon FilmFollower::polygon_of(const std::vector<double>& x, const std::vector<double>& y) {
  Polygon polygon;
  double last = 0.0;
  for (std::size_t k = 0; k + 1 < std::min(x.size(), Polygon::kCorners + 1); ++k) {
    const double slope = (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
    polygon.x[k] = x[k];
    polygon.change[k] = slope - last;
    last = slope;
  }
  return polygon;
}

void FilmFollower::hold(const FilmConductances& film) noexcept {
  if (!film_) return;
  conductances_.between_rows = film.between_rows;
  conductances_.between_cols = film.between_cols;
  follows_ = false;
}

void FilmFollower::forget() noexcept {
  if (!follows_) return;
  for (auto* between : {&conductances_.between_rows, &conductances_.between_cols}) {
    std::fill(between->begin(), between->end(), 1.0 / film_->unloaded_ohm);
  }
}

bool FilmFollower::follow(std::span<const double> siemens, std::size_t stride, Precision precision) noexcept {
  if (!follows_) return false;
  if (precision == Precision::single) {
    find_loads(siemens, stride, single_);
  } else {
    find_loads(siemens, stride, full_);
  }
  return true;
}

template <typename Real>
void FilmFollower::find_loads(std::span<const double> siemens, std::size_t stride, Loads<Real>& loads) noexcept {
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::size_t first = row * cols_;
    find_shares(&siemens[row * stride], &unloaded_[first], &scale_[first], &loads.pairs[first], cols_);
  }
  add_corners(loads_.x, loads_.change, loads.pairs.data(), loads.newtons.data(), loads.pairs.size());
  const double unloaded = 1.0 / film_->unloaded_ohm;
  std::fill(conductances_.between_cols.begin(), conductances_.between_cols.end(), unloaded);
  find_rises(1, loads);
  for (std::size_t row = 0; row < rows_; ++row) {
    add_row(&loads.rises[row * cols_], conductances_.between_cols.data(), cols_ - 1);
  }
  find_rises(cols_, loads);
  for (std::size_t row = 0; row + 1 < rows_; ++row) {
    conductances_.between_rows[row] = unloaded + sum_row(&loads.rises[row * cols_], cols_);
  }
}

/// Pairs of taxels that are so far from each other.
template <typename Real>
void FilmFollower::find_rises(std::size_t distance, Loads<Real>& loads) noexcept {
  const std::size_t count = loads.newtons.size() - distance;
  add_pairs(loads.newtons.data(), loads.newtons.data() + distance, loads.pairs.data(), count);
  add_corners(rise_.x, rise_.change, loads.pairs.data(), loads.rises.data(), count);
}

}  // namespace dermis::touch::compensation
