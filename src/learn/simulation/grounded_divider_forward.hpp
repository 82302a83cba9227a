// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::simulation {

/// Most rows, and most columns, that grounded_divider_ratios() takes: what it works on lies on the stack.
inline constexpr std::size_t kMostFastLines = 64;

/// A divider with grounded idle rows, all columns loaded, lines and supply without resistance and no film, of a size
/// that fits.
[[nodiscard]] bool fits_grounded_divider(const ArrayDescription& array) noexcept;

/// The readings of such an array over the supply, in SIMD lanes. The row lines are eliminated by hand: their block of
/// the nodal equations is diagonal, which also admits drivers of 0 ohm. A symmetric, diagonally dominant system is left
/// for the columns,
///
///   C = diag(1/RL_j + sum_i G_ij) - sum_i (Rd_i / a_i) g_i g_i^T,   a_i = 1 + Rd_i sum_j G_ij,   g_i row i of G,
///
/// which Gauss and Jordan invert without pivoting; the readings are diag(1/a) G C^-1. `siemens` and `ratio` are
/// [rows, cols]. Thread-safe.
void grounded_divider_ratios(const Readout& readout, std::span<const float> siemens, std::span<float> ratio) noexcept;
void grounded_divider_ratios(const Readout& readout, std::span<const double> siemens, std::span<double> ratio) noexcept;

}  // namespace dermis::learn::simulation
