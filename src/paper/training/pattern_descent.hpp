// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/network_shape.hpp"
#include "dermis/paper/samples.hpp"

namespace dermis::paper {

/// The rows of weights of a layer lie in SIMD lanes. They are rows of units, one for each input and one of the
/// thresholds. Or they are rows of inputs, one for each unit, with the threshold as the weight of a last input that is
/// 1. Each row begins at a cache line and ends with zeros.
template <std::floating_point Real>
struct LaneLayer {
  std::size_t units = 0;
  std::size_t fan_in = 0;
  Activation activation = Activation::linear;
  bool units_in_lanes = true;
  std::size_t row = 0;      ///< From one row to the next.
  Real* weights = nullptr;  ///< [rows, row]
  Real* steps = nullptr;    ///< The same of the momentum.
  Real* outputs = nullptr;  ///< [units], then a 1, then zeros to the end of the cache line.
  Real* deltas = nullptr;   ///< d eq. (5) / d output [units], and as many more.

  [[nodiscard]] std::size_t rows() const noexcept { return units_in_lanes ? fan_in + 1 : units; }
  [[nodiscard]] std::size_t columns() const noexcept { return units_in_lanes ? units : fan_in + 1; }
  /// Input fan_in is the threshold.
  [[nodiscard]] std::size_t place(std::size_t unit, std::size_t input) const noexcept {
    return units_in_lanes ? input * row + unit : unit * row + input;
  }
};

/// How the patterns are walked through.
template <std::floating_point Real>
struct PatternWalk {
  const Samples<Real>& samples;
  std::span<const std::size_t> order;
  Real rate;
  Real momentum;
};

/// Gradient descent pattern by pattern: the loop of Fig. 9 without batches. Nothing is allocated after the
/// construction.
template <std::floating_point Real>
class PatternDescent {
 public:
  explicit PatternDescent(const NetworkShape& shape);

  /// One step for each pattern of the order, along the gradient of eq. (5) times the pattern's weight:
  /// steps = momentum steps - rate gradient, parameters += steps.
  void epoch(const PatternWalk<Real>& walk, std::span<Real> parameters, std::span<Real> steps);

 private:
  std::vector<CacheLine<Real>> memory_;
  std::vector<LaneLayer<Real>> layers_;
};

}  // namespace dermis::paper
