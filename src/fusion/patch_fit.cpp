// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fusion/patch_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dermis::fusion {
namespace {

constexpr int kMostEvaluations = 7;
constexpr float kSmallStep = 0.05F;  // in radii of a taxel and in the logarithm of the radius: its square is negligible
constexpr double kLongestStep = 1.0;
constexpr double kDamping = 1e-3;

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

Sums sum_up(std::span<const FitTaxel> taxels, const PatchResponse& response, const Patch& patch) {
  const PatchResponse::Row row = response.row(patch.log_radius);
  Sums sums;
  for (const FitTaxel& taxel : taxels) {
    const float dx = patch.x - taxel.x;
    const float dy = patch.y - taxel.y;
    const float distance = std::sqrt(dx * dx + dy * dy + 1e-12F);
    const PatchResponse::Cell cell = row.cell(distance);
    const Lanes lower = load(cell.lower) + cell.right * (load(cell.lower + 4) - load(cell.lower));
    const Lanes upper = load(cell.upper) + cell.right * (load(cell.upper + 4) - load(cell.upper));
    const float per_length = taxel.weight / distance;
    const Lanes scale{per_length * dx, per_length * dy, taxel.weight, taxel.weight};
    const Lanes slope = scale * (lower + row.up() * (upper - lower));
    const float residual = taxel.weight * taxel.newtons - patch.newtons * slope[3];
    for (std::size_t k = 0; k < 4; ++k) sums.products[k] += slope[k] * slope;
    sums.residuals += residual * slope;
    sums.squares += residual * residual;
  }
  return sums;
}

/// The normal equations in x, y and ln radius, where the force follows as the best at each place and radius.
struct Normal {
  double newtons = 0.0;               // the best
  std::array<double, 3> per_force{};  // -d ln force / d (x, y, ln radius)
  std::array<double, 6> matrix{};     // lower triangle, row by row
  std::array<double, 3> slope{};      // -d (chi squared / 2)
  double chi_squared = 0.0;
};

Normal normal_equations(std::span<const FitTaxel> taxels, const PatchResponse& response, const Patch& patch,
                        const RadiusPrior& prior) {
  const Sums sums = sum_up(taxels, response, patch);
  const double share_square = std::max(static_cast<double>(sums.products[3][3]), 1e-12);
  const double more = std::max(sums.residuals[3] / share_square, 1e-6 - patch.newtons);
  Normal normal;
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
  return normal;
}

/// The matrix with `damping` times its diagonal added, as L D L^T.
class Factor {
 public:
  Factor(const std::array<double, 6>& matrix, double damping) {
    const std::array<double, 3> diagonal{pivot(matrix[0], damping), pivot(matrix[2], damping),
                                         pivot(matrix[5], damping)};
    inverse_[0] = 1.0 / diagonal[0];
    l10_ = matrix[1] * inverse_[0];
    l20_ = matrix[3] * inverse_[0];
    inverse_[1] = 1.0 / std::max(diagonal[1] - l10_ * matrix[1], kLeastPivot * diagonal[1]);
    const double rest = matrix[4] - l20_ * matrix[1];
    l21_ = rest * inverse_[1];
    inverse_[2] = 1.0 / std::max(diagonal[2] - l20_ * matrix[3] - l21_ * rest, kLeastPivot * diagonal[2]);
  }

  [[nodiscard]] std::array<double, 3> solve(const std::array<double, 3>& right) const {
    const double y1 = right[1] - l10_ * right[0];
    const double y2 = right[2] - l20_ * right[0] - l21_ * y1;
    const double z2 = inverse_[2] * y2;
    const double z1 = inverse_[1] * y1 - l21_ * z2;
    return {inverse_[0] * right[0] - l10_ * z1 - l20_ * z2, z1, z2};
  }

 private:
  static constexpr double kLeastPivot = 1e-6;

  /// Above 0, though rounding may have taken the diagonal below.
  static double pivot(double diagonal, double damping) { return std::max(diagonal, 0.0) * (1.0 + damping) + 1e-9; }

  std::array<double, 3> inverse_{};  // of D
  double l10_ = 0.0;
  double l20_ = 0.0;
  double l21_ = 0.0;
};

Patch moved(const Patch& patch, const Normal& normal, const std::array<double, 3>& step) {
  static const float kLow = std::log(PatchResponse::kLeastRadius);
  static const float kHigh = std::log(PatchResponse::kMostRadius);
  double less = 0.0;
  for (std::size_t k = 0; k < 3; ++k) less += normal.per_force[k] * step[k];
  return {patch.x + static_cast<float>(step[0]), patch.y + static_cast<float>(step[1]),
          std::clamp(patch.log_radius + static_cast<float>(step[2]), kLow, kHigh),
          static_cast<float>(normal.newtons * std::clamp(1.0 - less, 0.1, 10.0))};
}

std::array<double, 3> next_step(const Normal& normal, double damping) {
  const std::array<double, 3> step = Factor(normal.matrix, damping).solve(normal.slope);
  return {std::clamp(step[0], -kLongestStep, kLongestStep), std::clamp(step[1], -kLongestStep, kLongestStep),
          std::clamp(step[2], -0.5 * kLongestStep, 0.5 * kLongestStep)};
}

bool is_small(const std::array<double, 3>& step) {
  return std::all_of(step.begin(), step.end(), [](double value) { return std::abs(value) < kSmallStep; });
}

}  // namespace

PatchFit fit_patch(std::span<const FitTaxel> taxels, PatchProfile profile, const Patch& start,
                   const RadiusPrior& prior) noexcept {
  const PatchResponse& response = PatchResponse::of(profile);
  Patch patch = start;
  Normal normal = normal_equations(taxels, response, patch, prior);
  double damping = kDamping;
  for (int k = 1;; ++k) {
    const std::array<double, 3> step = next_step(normal, damping);
    if (!std::isfinite(step[0] + step[1] + step[2])) break;
    const Patch tried = moved(patch, normal, step);
    if (is_small(step)) {
      patch = tried;
      break;
    }
    if (k == kMostEvaluations) break;
    const Normal there = normal_equations(taxels, response, tried, prior);
    if (!(there.chi_squared <= normal.chi_squared)) {
      damping = std::max(10.0 * damping, 0.1);
      continue;
    }
    patch = tried;
    normal = there;
    damping *= 0.1;
  }
  const Factor factor(normal.matrix, 0.0);
  return {patch, profile, static_cast<float>(factor.solve({1.0, 0.0, 0.0})[0]),
          static_cast<float>(factor.solve({0.0, 1.0, 0.0})[1]), static_cast<float>(normal.chi_squared)};
}

}  // namespace dermis::fusion
