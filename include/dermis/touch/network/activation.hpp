// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>

namespace dermis::touch::network {

/// The transfer function of a neuron, from the sum of its inputs and threshold to its output.
enum class Activation : std::uint8_t {
  log_sigmoid,  ///< 1 / (1 + exp(-x)), eq. (3) of the paper, Fig. 10; output in (0, 1).
  tanh,         ///< Output in (-1, 1).
  relu,         ///< max(0, x); slope 0 at 0.
  linear,       ///< x, MATLAB's purelin.
};

/// "log_sigmoid", "tanh", "relu" or "linear".
[[nodiscard]] std::string_view name(Activation activation) noexcept;

/// f(sum), to the precision of the C library. Finite for every finite sum. Thread-safe.
template <std::floating_point Real>
[[nodiscard]] Real activate(Activation activation, Real sum) noexcept;

/// f'(sum) as a function of f(sum): y (1 - y), 1 - y^2, y > 0, 1. Thread-safe.
template <std::floating_point Real>
[[nodiscard]] Real slope_from_output(Activation activation, Real output) noexcept;

}  // namespace dermis::touch::network
