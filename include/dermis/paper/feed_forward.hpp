// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/paper/network_shape.hpp"
#include "dermis/paper/samples.hpp"

namespace dermis::paper {

template <std::floating_point Real>
class FeedForward;

/// A cache line of values: a vector of them begins where SIMD loads are fastest.
template <std::floating_point Real>
struct alignas(64) CacheLine {
  Real values[64 / sizeof(Real)];
};

/// Samples in the layout of the engine; packed once, used in every epoch. Belongs to networks with as many inputs and
/// outputs as the one it was packed for.
template <std::floating_point Real>
class PackedSamples {
 public:
  PackedSamples() = default;
  /// All patterns. They must have passed check_samples().
  PackedSamples(const NetworkShape& shape, const Samples<Real>& samples);

  /// The patterns of the given indices, a mini-batch, reusing the buffers.
  void pack(const NetworkShape& shape, const Samples<Real>& samples, std::span<const std::size_t> indices);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  friend class FeedForward<Real>;
  [[nodiscard]] const Real* tiles() const noexcept;

  std::size_t count_ = 0;
  std::size_t rows_ = 0;
  std::vector<CacheLine<Real>> tiles_;
};

/// The BP network: forward and backward passes over batches of samples for networks of any depth, samples side by side
/// in SIMD lanes. The output of a neuron is right to 2e-7 in float and 4e-16 in double, absolute; instruction sets
/// differ in rounding. An object holds work space: use one per thread. The shape must be valid. Nothing is allocated
/// once the work space has grown to what is asked of it.
template <std::floating_point Real>
class FeedForward {
 public:
  explicit FeedForward(NetworkShape shape);

  [[nodiscard]] const NetworkShape& shape() const noexcept { return shape_; }

  /// Eq. (4) for each pattern: inputs [count, inputs] -> outputs [count, outputs], row-major.
  void evaluate(std::span<const Real> parameters, std::span<const Real> inputs, std::span<Real> outputs);

  /// E of eq. (6), each pattern times its weight: 1/2 sum_p w_p sum_k (t_pk - o_pk)^2.
  [[nodiscard]] double error(std::span<const Real> parameters, const PackedSamples<Real>& samples);

  /// The same and dE/dparameter in `gradient` [parameter_count]: the backward pass of Fig. 9.
  double error_and_gradient(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                            std::span<Real> gradient);

  /// Also computes the normal equations of the Levenberg-Marquardt step: J^T W J in `normal` [n, n] (both triangles),
  /// with n = parameter_count. J = d output / d parameter, in sums over patterns and outputs. The Jacobian is never
  /// stored.
  double normal_equations(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                          std::span<Real> gradient, std::span<Real> normal);

 private:
  NetworkShape shape_;
  std::vector<CacheLine<Real>> work_;
};

}  // namespace dermis::paper
