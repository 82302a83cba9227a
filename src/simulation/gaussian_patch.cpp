// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "simulation/gaussian_patch.hpp"

#include <cmath>

namespace dermis::simulation {
namespace {

constexpr double kNarrowestPitches = 0.7;
constexpr double kWidestPitches = 2.5;
constexpr double kEdgeN = 0.02;

}  // namespace

GaussianPatch draw_patch(const ArrayDescription& array, Random& random) {
  GaussianPatch patch;
  patch.sigma_pitches = random.uniform(kNarrowestPitches, kWidestPitches);
  patch.row = random.uniform(-0.5, static_cast<double>(array.rows) - 0.5);
  patch.col = random.uniform(-0.5, static_cast<double>(array.cols) - 0.5);
  return patch;
}

void add_patch(const ArrayDescription& array, const GaussianPatch& patch, double peak_n, std::vector<double>& force_n) {
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      const double away_rows = (static_cast<double>(row) - patch.row) / patch.sigma_pitches;
      const double away_cols = (static_cast<double>(col) - patch.col) / patch.sigma_pitches;
      const double share_n = peak_n * std::exp(-0.5 * (away_rows * away_rows + away_cols * away_cols));
      if (share_n >= kEdgeN) force_n[array.index(row, col)] += share_n;
    }
  }
}

}  // namespace dermis::simulation
