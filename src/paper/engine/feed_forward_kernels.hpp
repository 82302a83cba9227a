// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>

#include "dermis/paper/samples.hpp"
#include "paper/engine/placed_shape.hpp"

namespace dermis::paper {

/// Samples side by side in a tile: every input, target, output and delta of a tile is a row of this many values. A
/// multiple of the lanes of every instruction set; a tile of a small network stays in the L1 cache.
inline constexpr std::size_t kTile = 128;

inline constexpr std::size_t kCacheLineBytes = 64;

/// Rows of a tile of packed samples: the inputs, the targets, the weights. Samples that fill up the last tile repeat
/// the last pattern with weight 0.
inline std::size_t packed_rows(const PlacedShape& shape) {
  return shape.inputs + shape.outputs() + 1;
}

/// Places in the work space of FeedForward, in values; each begins a cache line. The values for evaluate() come first,
/// then those for the gradient, then the normal equations.
template <std::floating_point Real>
struct WorkSpace {
  static constexpr std::size_t kLine = kCacheLineBytes / sizeof(Real);

  explicit WorkSpace(const PlacedShape& shape) {
    std::size_t size = 0;
    const auto allocate = [&size](std::size_t count) {
      const std::size_t begin = size;
      size += (count + kLine - 1) / kLine * kLine;
      return begin;
    };
    prepared = allocate(shape.parameters);
    inputs = allocate(shape.inputs * kTile);
    outputs = allocate(shape.units * kTile);
    evaluate_size = size;
    deltas[0] = allocate(shape.widest * kTile);
    deltas[1] = allocate(shape.widest * kTile);
    sums = allocate(shape.parameters * kLine);
    gradient_size = size;
    rows = shape.parameters - (shape.outputs() - 1) * (shape.top().fan_in + 1) + 1;
    jacobian = allocate(rows * kTile);
    const std::size_t blocks = (rows + kBlock - 1) / kBlock;
    products = allocate(blocks * (blocks + 1) / 2 * kBlock * kBlock);
    normal_size = size;
  }

  /// Rows and columns of a block of the normal matrix.
  static constexpr std::size_t kBlock = 4;

  std::size_t prepared;        ///< The parameters, scaled for the activation functions.
  std::size_t inputs;          ///< Inputs of one tile [inputs, kTile], where they are not packed.
  std::size_t outputs;         ///< Of every layer [units, kTile].
  std::size_t deltas[2] = {};  ///< dE/dsum of two layers in turn [units, kTile].
  std::size_t sums;            ///< The gradient, still apart in lanes [parameters, kLine].
  std::size_t rows;            ///< Parameters that one output depends on, and one for its residual.
  std::size_t jacobian;        ///< Of one output [rows, kTile].
  std::size_t products;        ///< Its J^T J, lower triangle of blocks [kBlock, kBlock].
  std::size_t evaluate_size;
  std::size_t gradient_size;
  std::size_t normal_size;
};

/// The work of FeedForward and PackedSamples for one instruction set. `work` begins a cache line, as do `tiles`
/// [ceil(count / kTile), packed_rows, kTile].
template <std::floating_point Real>
struct FeedForwardKernels {
  void (*pack)(const PlacedShape& shape, const Samples<Real>& samples, std::span<const std::size_t> indices,
               Real* tiles);
  void (*evaluate)(const PlacedShape& shape, const Real* parameters, const Real* inputs, std::size_t count,
                   Real* outputs, Real* work);
  double (*error)(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count, Real* work);
  double (*error_and_gradient)(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count,
                               Real* gradient, Real* work);
  double (*normal_equations)(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count,
                             Real* gradient, Real* normal, Real* work);
};

}  // namespace dermis::paper
