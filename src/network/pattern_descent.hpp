// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/network/network_shape.hpp"
#include "dermis/network/samples.hpp"

namespace dermis::network {

/// Gradient descent pattern by pattern: the loop of Fig. 9 with no batch in it. Nothing is allocated after the
/// construction.
template <std::floating_point Real>
class PatternDescent {
 public:
  explicit PatternDescent(NetworkShape shape);

  /// One step for each pattern of `order`, along the gradient of eq. (5) times the pattern's weight:
  /// steps = momentum steps - rate gradient, parameters += steps.
  void epoch(const Samples<Real>& samples, std::span<const std::size_t> order, Real rate, Real momentum,
             std::span<Real> parameters, std::span<Real> steps);

 private:
  void forward(const Real* inputs, const Real* parameters);
  void backward(const Real* inputs, Real rate, Real momentum, Real* parameters, Real* steps);

  NetworkShape shape_;
  std::vector<std::size_t> first_units_;  ///< Where the neurons of a layer are in what follows.
  std::vector<Real> outputs_;
  std::vector<Real> deltas_;  ///< d eq. (5) / d output, later / d sum.
};

}  // namespace dermis::network
