// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// A taxel that nothing touches reads less than so many times what it was calibrated to read unloaded, whatever its
/// temperature and its age.
inline constexpr double kTouchedShare = 3.0;

/// A taxel that conducts (or reads) more than this is touched. `unloaded`: what it conducts unloaded, >= 0; `sigma`:
/// the standard deviation of what it conducts now, of which `sigmas` are left to the noise.
[[nodiscard]] constexpr double touched_above(double unloaded, double sigma, double sigmas) noexcept {
  return kTouchedShare * unloaded + sigmas * sigma;
}

}  // namespace dermis
