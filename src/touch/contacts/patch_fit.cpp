// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_fit.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::touch::contacts {
namespace {

constexpr int kMostEvaluations = 7;
constexpr float kSmallStep = 0.05F;  // in radii of a taxel and in the logarithm of the radius: its square is negligible
constexpr double kLongestStep = 1.0;
constexpr double kDamping = 1e-3;

Patch moved(const Patch& patch, const NormalEquations& normal, const std::array<double, 3>& step) {
  static const float kLow = std::log(PatchResponse::kLeastRadius);
  static const float kHigh = std::log(PatchResponse::kMostRadius);
  double less = 0.0;
  for (std::size_t k = 0; k < 3; ++k) less += normal.per_force[k] * step[k];
  return {patch.x + static_cast<float>(step[0]), patch.y + static_cast<float>(step[1]),
          std::clamp(patch.log_radius + static_cast<float>(step[2]), kLow, kHigh),
          static_cast<float>(normal.newtons * std::clamp(1.0 - less, 0.1, 10.0))};
}

std::array<double, 3> next_step(const NormalEquations& normal, double damping) {
  const std::array<double, 3> step = Factor(normal.matrix, damping).solve(normal.slope);
  return {std::clamp(step[0], -kLongestStep, kLongestStep), std::clamp(step[1], -kLongestStep, kLongestStep),
          std::clamp(step[2], -0.5 * kLongestStep, 0.5 * kLongestStep)};
}

bool is_small(const std::array<double, 3>& step) {
  return std::all_of(step.begin(), step.end(), [](double value) { return std::abs(value) < kSmallStep; });
}

}  // namespace

PatchFit fit_patch(std::span<const FitTaxel> taxels, const PatchResponses& responses, PatchProfile profile,
                   const Patch& start, const PatchPrior& prior) noexcept {
  const PatchResponse& response = responses.of(profile);
  Patch patch = start;
  NormalEquations normal = normal_equations(taxels, response, patch, prior);
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
    const NormalEquations there = normal_equations(taxels, response, tried, prior);
    if (!(there.chi_squared <= normal.chi_squared)) {
      damping = std::max(10.0 * damping, 0.1);
      continue;
    }
    patch = tried;
    normal = there;
    damping *= 0.1;
  }
  const Factor factor(normal.matrix, 0.0);
  const auto freedom = static_cast<double>(std::max<std::size_t>(taxels.size(), 5) - 4);
  const double misfit = std::max(1.0, normal.chi_squared / freedom);
  return {patch,
          profile,
          static_cast<float>(misfit * factor.solve({1.0, 0.0, 0.0})[0]),
          static_cast<float>(misfit * factor.solve({0.0, 1.0, 0.0})[1]),
          static_cast<float>(normal.chi_squared),
          static_cast<float>(misfit)};
}

}  // namespace dermis::touch::contacts
