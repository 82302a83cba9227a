// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_equations.hpp"

#include <cmath>
#include <cstring>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::contacts {
namespace {

using Lanes [[gnu::vector_size(16)]] = float;  // of GCC and Clang, on every processor

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// Sums over the taxels with the weighted slopes g = d share / d (x, y, ln radius) and the share itself, g3.
struct Sums {
  std::array<Lanes, 4> products{};  // g g^T
  Lanes residuals{};                // g r
  float squares = 0.0F;             // r^2
};

DERMIS_PROCESSOR_CLONES Sums sum_up(std::span<const FitTaxel> taxels, const PatchResponse& response,
                                    const Patch& patch) {
  const PatchResponse::Row row = response.row(patch.log_radius);
  Lanes x_products{};
  Lanes y_products{};
  Lanes radius_products{};
  Lanes share_products{};
  Lanes residuals{};
  float squares = 0.0F;
  for (const FitTaxel& taxel : taxels) {
    const float measured = taxel.weight * taxel.newtons;
    const float dx = patch.x - taxel.x;
    const float dy = patch.y - taxel.y;
    const float square = dx * dx + dy * dy + 1e-12F;
    if (square > row.reach() * row.reach()) {
      squares += measured * measured;
      continue;
    }
    const float distance = std::sqrt(square);
    const PatchResponse::Cell cell = row.cell(distance);
    const Lanes lower = load(cell.lower) + cell.right * (load(cell.lower + 4) - load(cell.lower));
    const Lanes upper = load(cell.upper) + cell.right * (load(cell.upper + 4) - load(cell.upper));
    const float per_length = taxel.weight / distance;
    const Lanes scale{per_length * dx, per_length * dy, taxel.weight, taxel.weight};
    const Lanes slope = scale * (lower + row.up() * (upper - lower));
    const float residual = measured - patch.newtons * slope[3];
    x_products += slope[0] * slope;
    y_products += slope[1] * slope;
    radius_products += slope[2] * slope;
    share_products += slope[3] * slope;
    residuals += residual * slope;
    squares += residual * residual;
  }
  return {{x_products, y_products, radius_products, share_products}, residuals, squares};
}

}  // namespace

NormalEquations normal_equations(std::span<const FitTaxel> taxels, const PatchResponse& response, const Patch& patch,
                                 const PatchPrior& prior) noexcept {
  const Sums sums = sum_up(taxels, response, patch);
  const double share_square = std::max(static_cast<double>(sums.products[3][3]), 1e-12);
  const double more = std::max(sums.residuals[3] / share_square, 1e-6 - patch.newtons);
  NormalEquations normal;
  normal.newtons = patch.newtons + more;
  std::size_t entry = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    normal.per_force[i] = sums.products[3][i] / share_square;
    for (std::size_t k = 0; k <= i; ++k) {
      const double product = sums.products[i][k] - normal.per_force[i] * sums.products[3][k];
      normal.matrix[entry++] = normal.newtons * normal.newtons * product;
    }
    normal.slope[i] = normal.newtons * (sums.residuals[i] - more * sums.products[3][i]);
  }
  normal.chi_squared = sums.squares - more * (2.0 * sums.residuals[3] - more * share_square);
  const double strength = 1.0 / (prior.sigma * prior.sigma);
  const double off = patch.log_radius - prior.log_radius;
  normal.matrix[5] += strength;
  normal.slope[2] -= strength * off;
  normal.chi_squared += strength * off * off;
  normal.matrix[0] += prior.strength_x;
  normal.matrix[2] += prior.strength_y;
  normal.slope[0] -= prior.strength_x * patch.x;
  normal.slope[1] -= prior.strength_y * patch.y;
  normal.chi_squared += prior.strength_x * patch.x * patch.x + prior.strength_y * patch.y * patch.y;
  return normal;
}

}  // namespace dermis::touch::contacts
