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

template <std::size_t Corners>
DERMIS_PROCESSOR_CLONES void add_corners(const std::array<float, Corners>& x, const std::array<float, Corners>& change,
                                         const float* __restrict from, float* __restrict to, std::size_t count) {
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) {
    float sum = 0.0F;
    for (std::size_t corner = 0; corner < Corners; ++corner) {
      const float beyond = from[k] - x[corner];
      sum += change[corner] * (beyond > 0.0F ? beyond : 0.0F);
    }
    to[k] = sum;
  }
}

}  // namespace

FilmFollower::FilmFollower(const ArrayDescription& array, const ReferenceConductances& references)
    : film_(array.readout.film), rows_(array.rows), cols_(array.cols), conductances_(array.rows, array.cols) {
  if (!film_) return;
  for (auto* values : {&newtons_, &pairs_, &rises_}) values->resize(array.taxel_count());
  conductances_.set(*film_, std::span<const float>(newtons_));
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
    polygon.x[k] = static_cast<float>(x[k]);
    polygon.change[k] = static_cast<float>(slope - last);
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

bool FilmFollower::follow(std::span<const double> siemens, std::size_t stride) noexcept {
  if (!follows_) return false;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t taxel = row * cols_ + col;
      pairs_[taxel] = static_cast<float>((siemens[row * stride + col] - unloaded_[taxel]) * scale_[taxel]);
    }
  }
  loads_.apply(pairs_.data(), newtons_.data(), pairs_.size());
  const double unloaded = 1.0 / film_->unloaded_ohm;
  std::fill(conductances_.between_cols.begin(), conductances_.between_cols.end(), unloaded);
  find_rises(newtons_.data(), newtons_.data() + 1, newtons_.size() - 1);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col + 1 < cols_; ++col)
      conductances_.between_cols[col] += static_cast<double>(rises_[row * cols_ + col]);
  }
  find_rises(newtons_.data(), newtons_.data() + cols_, newtons_.size() - cols_);
  for (std::size_t row = 0; row + 1 < rows_; ++row) {
    double sum = unloaded;
    for (std::size_t col = 0; col < cols_; ++col) sum += static_cast<double>(rises_[row * cols_ + col]);
    conductances_.between_rows[row] = sum;
  }
  return true;
}

/// `rises_` of pairs of taxels.
void FilmFollower::find_rises(const float* own, const float* other, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) pairs_[k] = own[k] + other[k];
  rise_.apply(pairs_.data(), rises_.data(), count);
}

void FilmFollower::Polygon::apply(const float* from, float* to, std::size_t count) const noexcept {
  add_corners(x, change, from, to, count);
}

}  // namespace dermis::touch::compensation
