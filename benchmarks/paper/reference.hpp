// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/paper/network_shape.hpp"

/// What the engines are checked against: the network of eq. (4) of the paper and its gradients in double precision,
/// loop by loop, sharing nothing with any engine.
namespace dermis::benchmarks::reference {

[[nodiscard]] std::vector<double> as_double(std::span<const float> values);

/// inputs [count, inputs] -> outputs [count, outputs].
[[nodiscard]] std::vector<double> outputs(const paper::NetworkShape& shape, std::span<const double> parameters,
                                          std::span<const double> inputs);

struct ErrorAndGradient {
  double error = 0.0;  ///< 1/2 sum over all patterns and outputs of (t - o)^2, eq. (6).
  std::vector<double> gradient;
};
[[nodiscard]] ErrorAndGradient error_and_gradient(const paper::NetworkShape& shape, std::span<const double> parameters,
                                                  std::span<const double> inputs, std::span<const double> targets);

/// d output / d parameter, [count, parameter_count], of a network with one output.
[[nodiscard]] std::vector<double> jacobian(const paper::NetworkShape& shape, std::span<const double> parameters,
                                           std::span<const double> inputs);

/// Solves A x = b for a symmetric positive definite A [n, n] by Cholesky's factors; A is overwritten, b becomes x.
void solve(std::span<double> matrix, std::span<double> vector);

/// The largest |value - expected|; infinite where a value is not a number.
[[nodiscard]] double max_deviation(std::span<const double> values, std::span<const double> expected);

}  // namespace dermis::benchmarks::reference
