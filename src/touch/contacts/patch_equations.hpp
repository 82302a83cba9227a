// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "touch/contacts/patch_response.hpp"

namespace dermis::touch::contacts {

/// The evidence of one taxel on a patch; lengths in radii of the taxel.
struct FitTaxel {
  float x = 0.0F;
  float y = 0.0F;
  float newtons = 0.0F;
  float weight = 0.0F;  ///< 1 / standard deviation [1/N], the mismatch of the model included.
};

/// A round patch of pressure; lengths in radii of the taxel.
struct Patch {
  float x = 0.0F;
  float y = 0.0F;
  float log_radius = 0.0F;
  float newtons = 0.0F;  ///< In all, between the taxels too.
};

/// Prior knowledge of a patch: its radius, normal in the logarithm, and its place across a strip of taxels, which does
/// not measure it.
struct PatchPrior {
  float log_radius = 0.0F;
  float sigma = 1.0F;
  float strength_x = 0.0F;  ///< 1 / variance of x about 0.
  float strength_y = 0.0F;  ///< 1 / variance of y about 0.
};

/// The normal equations in x, y and ln radius, where the force follows as the best at each place and radius.
struct NormalEquations {
  double newtons = 0.0;               // the best
  std::array<double, 3> per_force{};  // -d ln force / d (x, y, ln radius)
  std::array<double, 6> matrix{};     // lower triangle, row by row
  std::array<double, 3> slope{};      // -d (chi squared / 2)
  double chi_squared = 0.0;
};

[[nodiscard]] NormalEquations normal_equations(std::span<const FitTaxel> taxels, const PatchResponse& response,
                                               const Patch& patch, const PatchPrior& prior) noexcept;

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

}  // namespace dermis::touch::contacts
