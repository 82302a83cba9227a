// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// An untouched taxel reads less than this many times its calibrated unloaded reading, whatever its temperature and its
/// age.
inline constexpr double kTouchedShare = 3.0;

/// A taxel with a higher conductance (or reading) is touched. `unloaded`: its unloaded conductance, >= 0; `sigma`: the
/// standard deviation of its present conductance; `sigmas`: how many of them count as noise.
[[nodiscard]] constexpr double touched_above(double unloaded, double sigma, double sigmas) noexcept {
  return kTouchedShare * unloaded + sigmas * sigma;
}

}  // namespace dermis
