// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "touch/contacts/patch_equations.hpp"

namespace dermis::touch::contacts {

struct PatchFit {
  Patch patch;
  PatchProfile profile = PatchProfile::hertz;
  float variance_x = 0.0F;   ///< Times misfit.
  float variance_y = 0.0F;   ///< Times misfit.
  float chi_squared = 0.0F;  ///< Of the residuals and the prior.
  float misfit = 1.0F;       ///< Chi squared per degree of freedom, at least 1.
};

/// The most likely patch, by Levenberg and Marquardt's method from `start`, whose force may be far off.
[[nodiscard]] PatchFit fit_patch(std::span<const FitTaxel> taxels, const PatchResponses& responses,
                                 PatchProfile profile, const Patch& start, const PatchPrior& prior) noexcept;

/// `most_likely` with the mean place and radius of all patches of its profile, each by its likelihood, and the variance
/// over them. Larger and smaller patches at other places explain few taxels nearly as well.
[[nodiscard]] PatchFit mean_over_radii(std::span<const FitTaxel> taxels, const PatchResponses& responses,
                                       const PatchFit& most_likely, const PatchPrior& prior) noexcept;

/// The better of both with the mean place and radius of both, each by its likelihood, and the variance over both.
[[nodiscard]] PatchFit mean_of_profiles(const PatchFit& one, const PatchFit& other) noexcept;

}  // namespace dermis::touch::contacts
