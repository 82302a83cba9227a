// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <span>

#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// Patterns to learn from (p = 1 ... P of the paper). A view: what it shows must outlive it.
template <std::floating_point Real>
struct Samples {
  std::size_t count = 0;          ///< P
  std::span<const Real> inputs;   ///< [count, network inputs], row-major.
  std::span<const Real> targets;  ///< t_pk, [count, network outputs], row-major.
  std::span<const Real> weights;  ///< Weight of each pattern's squared error, >= 0, [count]; empty: all 1.
};

/// Whether samples can be trained on: sizes fit `inputs` and `outputs`, there is at least one pattern, and all values
/// are finite. Weights must not be negative, nor all 0. The error names the first bad pattern.
template <std::floating_point Real>
[[nodiscard]] Status check_samples(const Samples<Real>& samples, std::size_t inputs, std::size_t outputs);

}  // namespace dermis::paper
