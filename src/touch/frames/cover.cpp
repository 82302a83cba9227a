// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/cover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis {
namespace {

constexpr double kReachSigmas = 4.5;
constexpr double kMostReachPitches = 64.0;

/// Lines to which a spread of this many pitches hands on a force, of an array of `lines`.
std::size_t gaussian_reach(double pitches, std::size_t lines) {
  const double reach = std::ceil(std::min(kReachSigmas * pitches, kMostReachPitches));
  return std::min(static_cast<std::size_t>(reach), lines - 1);
}

/// Below half a pitch either side of the centre the share is 1.
double gaussian_below(double place, double pitches) {
  if (!(pitches > 0.0)) return place < 0.0 ? 0.0 : 1.0;
  return 0.5 * std::erfc(-place / (pitches * std::numbers::sqrt2));
}

}  // namespace

bool Cover::is_unknown() const noexcept {
  return shares.empty() && std::isnan(spread_m);
}

double gaussian_share(double spread_pitches, std::size_t pitches) noexcept {
  const auto place = static_cast<double>(pitches);
  return gaussian_below(place + 0.5, spread_pitches) - gaussian_below(place - 0.5, spread_pitches);
}

double gaussian_spread(double centre_share) noexcept {
  constexpr int kHalvings = 40;
  double low = 0.0;
  double high = 20.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (gaussian_share(middle, 0) > centre_share ? low : high) = middle;
  }
  return low;
}

CoverKernel::CoverKernel(const ArrayDescription& array) : rows_(array.rows), cols_(array.cols) {
  if (!array.cover) return;
  if (array.cover->shares.empty()) {
    set_gaussian(array);
  } else {
    set_shares(array);
  }
}

void CoverKernel::set_gaussian(const ArrayDescription& array) {
  row_spread_m_ = col_spread_m_ = array.cover->spread_m;
  const double row_pitches = row_spread_m_ / array.row_pitch_m;
  const double col_pitches = col_spread_m_ / array.col_pitch_m;
  quadrant_rows_ = gaussian_reach(row_pitches, rows_) + 1;
  quadrant_cols_ = gaussian_reach(col_pitches, cols_) + 1;
  shares_.clear();
  for (std::size_t row = 0; row < quadrant_rows_; ++row) {
    for (std::size_t col = 0; col < quadrant_cols_; ++col) {
      shares_.push_back(gaussian_share(row_pitches, row) * gaussian_share(col_pitches, col));
    }
  }
}

void CoverKernel::set_shares(const ArrayDescription& array) {
  for (const CoverShare& share : array.cover->shares) {
    quadrant_rows_ = std::min(rows_, std::max(quadrant_rows_, share.rows + 1));
    quadrant_cols_ = std::min(cols_, std::max(quadrant_cols_, share.cols + 1));
  }
  shares_.assign(quadrant_rows_ * quadrant_cols_, 0.0);
  double of_row = 0.0;
  double of_col = 0.0;
  for (const auto& [rows, cols, share] : array.cover->shares) {
    if (rows == 0) of_row += cols > 0 ? 2.0 * share : share;
    if (cols == 0) of_col += rows > 0 ? 2.0 * share : share;
    if (rows < quadrant_rows_ && cols < quadrant_cols_) shares_[rows * quadrant_cols_ + cols] = share;
  }
  row_spread_m_ = gaussian_spread(of_row) * array.row_pitch_m;
  col_spread_m_ = gaussian_spread(of_col) * array.col_pitch_m;
}

template <typename Number>
void CoverKernel::spread(std::span<const Number> surface, std::span<Number> felt) const noexcept {
  std::fill(felt.begin(), felt.end(), Number{0});
  for (std::size_t taxel = 0; taxel < surface.size(); ++taxel) {
    const Number force = surface[taxel];
    if (force == Number{0}) continue;
    const std::size_t row = taxel / cols_;
    const std::size_t col = taxel % cols_;
    const std::size_t last_row = std::min(rows_ - 1, row + row_reach());
    const std::size_t last_col = std::min(cols_ - 1, col + col_reach());
    for (std::size_t i = row - std::min(row, row_reach()); i <= last_row; ++i) {
      for (std::size_t j = col - std::min(col, col_reach()); j <= last_col; ++j) {
        felt[i * cols_ + j] +=
            static_cast<Number>(share(i > row ? i - row : row - i, j > col ? j - col : col - j)) * force;
      }
    }
  }
}

template void CoverKernel::spread(std::span<const double>, std::span<double>) const noexcept;
template void CoverKernel::spread(std::span<const float>, std::span<float>) const noexcept;

}  // namespace dermis
