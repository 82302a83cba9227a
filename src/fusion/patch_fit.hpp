// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "fusion/patch_response.hpp"

namespace dermis::fusion {

/// What one taxel says about a patch; lengths in radii of the taxel.
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

struct PatchFit {
  Patch patch;
  PatchProfile profile = PatchProfile::hertz;
  float variance_x = 0.0F;
  float variance_y = 0.0F;
  float chi_squared = 0.0F;  ///< Of the residuals and the prior.
};

/// What is known of a radius before anything is measured: normal in its logarithm.
struct RadiusPrior {
  float log_radius = 0.0F;
  float sigma = 1.0F;
};

/// The most likely patch, by Levenberg and Marquardt's method from `start`, whose force may be far off.
[[nodiscard]] PatchFit fit_patch(std::span<const FitTaxel> taxels, PatchProfile profile, const Patch& start,
                                 const RadiusPrior& prior) noexcept;

}  // namespace dermis::fusion
