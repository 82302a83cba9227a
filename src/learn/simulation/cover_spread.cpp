// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/cover_spread.hpp"

#include <cmath>
#include <numbers>

namespace dermis::learn::simulation {
namespace {

/// Shares of a Gaussian over cells of this pitch.
std::vector<double> shares_along(double spread_m, double pitch_m, std::size_t lines) {
  std::vector<double> shares(lines);
  for (std::size_t k = 0; k < lines; ++k) {
    const auto below = [&](double place) { return 0.5 * std::erf(place * pitch_m / (std::numbers::sqrt2 * spread_m)); };
    const auto centre = static_cast<double>(k);
    shares[k] = below(centre + 0.5) - below(centre - 0.5);
  }
  return shares;
}

std::size_t apart(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace

CoverSpread::CoverSpread(const ArrayDescription& array) : rows_(array.rows), cols_(array.cols) {
  if (!array.cover || (array.cover->shares.empty() && !(array.cover->spread_m > 0.0))) return;
  share_.assign(rows_, std::vector<double>(cols_));
  if (array.cover->shares.empty()) {
    const std::vector<double> down = shares_along(array.cover->spread_m, array.row_pitch_m, rows_);
    const std::vector<double> right = shares_along(array.cover->spread_m, array.col_pitch_m, cols_);
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t col = 0; col < cols_; ++col) share_[row][col] = down[row] * right[col];
    }
    return;
  }
  for (const auto& [rows, cols, share] : array.cover->shares) {
    if (rows < rows_ && cols < cols_) share_[rows][cols] = share;
  }
}

std::vector<double> CoverSpread::felt(const std::vector<double>& surface) const {
  if (share_.empty()) return surface;
  std::vector<double> felt(surface.size());
  for (std::size_t from = 0; from < surface.size(); ++from) {
    if (surface[from] == 0.0) continue;
    for (std::size_t to = 0; to < felt.size(); ++to) {
      felt[to] += surface[from] * share_[apart(from / cols_, to / cols_)][apart(from % cols_, to % cols_)];
    }
  }
  return felt;
}

}  // namespace dermis::learn::simulation
