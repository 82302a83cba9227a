// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <span>

namespace dermis::paper {

/// The paper's measures of the difference between targets t and outputs o. Summed in double precision; NaN where a
/// value is NaN. Both spans have the same size.

/// Eq. (5), of one pattern: E_p = 1/2 sum_k (t_pk - o_pk)^2.
template <std::floating_point Real>
[[nodiscard]] double pattern_error(std::span<const Real> targets, std::span<const Real> outputs) noexcept;

/// Eq. (6), of all patterns: E = 1/2 sum_p sum_k (t_pk - o_pk)^2. The paper calls it the average; as printed it is the
/// sum, and the sum is what its gradient descent follows.
template <std::floating_point Real>
[[nodiscard]] double total_error(std::span<const Real> targets, std::span<const Real> outputs) noexcept {
  return pattern_error(targets, outputs);
}

/// Eq. (2): E = 1/P sum_p e_p^2, the mean square over all values. At least one value.
template <std::floating_point Real>
[[nodiscard]] double mean_square_error(std::span<const Real> targets, std::span<const Real> outputs) noexcept {
  return 2.0 * pattern_error(targets, outputs) / static_cast<double>(targets.size());
}

}  // namespace dermis::paper
