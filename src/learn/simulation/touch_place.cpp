// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/touch_place.hpp"

#include <cmath>

namespace dermis::learn::simulation {
namespace {

constexpr double kSingleTaxelShare = 0.4;
constexpr double kNarrowestPitches = 0.7;
constexpr double kWidestPitches = 2.5;
constexpr double kEdgeN = 0.02;

}  // namespace

TouchPlace draw_place(const ArrayDescription& array, Random& random) {
  TouchPlace place;
  if (random.uniform() < kSingleTaxelShare) {
    place.taxel = random.below(array.taxel_count());
    return place;
  }
  place.sigma_pitches = random.uniform(kNarrowestPitches, kWidestPitches);
  place.row = random.uniform(-0.5, static_cast<double>(array.rows) - 0.5);
  place.col = random.uniform(-0.5, static_cast<double>(array.cols) - 0.5);
  return place;
}

void add_touch(const ArrayDescription& array, const TouchPlace& place, double peak_n, std::vector<double>& force_n) {
  if (place.taxel) {
    force_n[*place.taxel] += peak_n;
    return;
  }
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      const double away_rows = (static_cast<double>(row) - place.row) / place.sigma_pitches;
      const double away_cols = (static_cast<double>(col) - place.col) / place.sigma_pitches;
      const double share_n = peak_n * std::exp(-0.5 * (away_rows * away_rows + away_cols * away_cols));
      if (share_n >= kEdgeN) force_n[array.index(row, col)] += share_n;
    }
  }
}

}  // namespace dermis::learn::simulation
