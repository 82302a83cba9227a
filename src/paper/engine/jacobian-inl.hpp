// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The Jacobian of one output over a tile, and its products for the normal equations.
// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_JACOBIAN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_JACOBIAN_INL_HPP
#undef DERMIS_PAPER_JACOBIAN_INL_HPP
#else
#define DERMIS_PAPER_JACOBIAN_INL_HPP
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "hwy/highway.h"
#include "paper/engine/backward-inl.hpp"
#include "paper/engine/feed_forward_kernels.hpp"
#include "paper/engine/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// out [units, fan_in] rows = delta of each unit times each row below: dE/dweight of each sample.
template <class D, typename Real = hn::TFromD<D>>
void outer_products(D d, const Real* deltas, std::size_t units, const Real* below, std::size_t fan_in,
                    std::size_t vectors, Real* out) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  for (std::size_t u = 0; u < units; ++u) {
    for (std::size_t k = 0; k < fan_in; ++k) {
      for (std::size_t v = 0; v < vectors; ++v) {
        const auto delta = hn::Load(d, deltas + u * kTile + v * kLanes);
        const auto x = hn::Load(d, below + k * kTile + v * kLanes);
        hn::Store(hn::Mul(delta, x), d, out);
        out += kLanes;
      }
      out += kTile - vectors * kLanes;
    }
  }
}

/// The rows of one output's Jacobian for a tile, each sample times the root of its weight. They are the parameters of
/// the lower layers, weights and threshold of the output, and as the last row the residual. The derivatives by the
/// thresholds are the deltas, so these are made in place.
template <class D, typename Real = hn::TFromD<D>>
void jacobian_rows(D d, const PlacedShape& shape, std::size_t output, const Real* parameters, const Real* inputs,
                   const Real* targets, const Real* weights, std::size_t vectors, const WorkSpace<Real>& space,
                   Real* work) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const PlacedLayer& top = shape.top();
  const Real* outputs = work + space.outputs;
  Real* jacobian = work + space.jacobian;
  Real* residuals = jacobian + (space.rows - 1) * kTile;
  Real* deltas = residuals - kTile;
  for (std::size_t v = 0; v < vectors; ++v) {
    const auto root = hn::Sqrt(hn::Load(d, weights + v * kLanes));
    const auto y = hn::Load(d, outputs + (top.first_unit + output) * kTile + v * kLanes);
    hn::Store(through(d, top.activation, root, y), d, deltas + v * kLanes);
    const auto target = hn::Load(d, targets + output * kTile + v * kLanes);
    hn::Store(hn::Mul(root, hn::Sub(y, target)), d, residuals + v * kLanes);
  }
  PlacedLayer layer = top;  // of which only the one output takes part
  layer.units = 1;
  for (std::size_t l = shape.layer_count - 1; l > 0; --l) {
    const PlacedLayer& below = shape.layers[l - 1];
    outer_products(d, deltas, layer.units, outputs + below.first_unit * kTile, layer.fan_in, vectors,
                   jacobian + layer.weights * kTile);
    const std::size_t skipped = l + 1 == shape.layer_count ? output * layer.fan_in : 0;
    Real* deltas_below = jacobian + below.thresholds * kTile;
    layer_deltas(d, layer, below, parameters + layer.weights + skipped, deltas, outputs, vectors, deltas_below);
    deltas = deltas_below;
    layer = below;
  }
  outer_products(d, deltas, layer.units, inputs, layer.fan_in, vectors, jacobian + layer.weights * kTile);
}

/// out [8] += the sum of the lanes of each of eight vectors.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void add_sums(D d, const hn::Vec<D>* v, Real* out) {
  for (std::size_t k = 0; k < 8; ++k) out[k] += hn::GetLane(hn::SumOfLanes(d, v[k]));
}

#if HWY_TARGET <= HWY_AVX3
/// The same for eight lanes: 21 additions and moves in place of 8 times 6.
HWY_INLINE void add_sums(Lanes<double> d, const hn::Vec<Lanes<double>>* v, double* out) {
  const auto pairs = [d](auto a, auto b)
                         HWY_ATTR { return hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b)); };
  const auto quads = [&](std::size_t a, std::size_t b) HWY_ATTR {
    const auto low = pairs(v[a], v[a + 1]);
    const auto high = pairs(v[b], v[b + 1]);
    const auto sum = hn::Add(hn::ConcatLowerLower(d, high, low), hn::ConcatUpperUpper(d, high, low));
    return hn::Add(sum, hn::SwapAdjacentBlocks(sum));  // sums of a, a + 1 twice, of b, b + 1 twice
  };
  hn::Store(hn::Add(hn::Load(d, out), hn::OddEvenBlocks(quads(2, 6), quads(0, 4))), d, out);
}
#endif

/// products [kBlock, kBlock] += rows a times rows b, summed over samples; of a block on the diagonal only the lower
/// triangle. The last rows of a matrix may be fewer than kBlock.
template <std::size_t Rows, bool Diagonal, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void product_block(D d, const Real* a, const Real* b, std::size_t vectors, Real* products) {
  constexpr std::size_t kBlock = WorkSpace<Real>::kBlock;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  hn::Vec<D> sums[kBlock * kBlock];
  unroll<kBlock * kBlock>([&](auto k) HWY_ATTR { sums[k] = hn::Zero(d); });
  for (std::size_t v = 0; v < vectors; ++v) {
    hn::Vec<D> x[kBlock];
    unroll<(Diagonal ? Rows : kBlock)>([&](auto j) HWY_ATTR { x[j] = hn::Load(d, b + j * kTile + v * kLanes); });
    unroll<Rows>([&](auto i) HWY_ATTR {
      const auto y = Diagonal ? x[i] : hn::Load(d, a + i * kTile + v * kLanes);
      unroll<(Diagonal ? i + 1 : kBlock)>(
          [&](auto j) HWY_ATTR { sums[i * kBlock + j] = hn::MulAdd(y, x[j], sums[i * kBlock + j]); });
    });
  }
  unroll<(Rows * kBlock + 7) / 8>([&](auto k) HWY_ATTR { add_sums(d, sums + 8 * k, products + 8 * k); });
}

/// Block [block_row, block_column] of rows rows^T, whose blocks are stored row by row up to the diagonal.
template <std::size_t Rows, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void add_block(D d, const Real* rows, std::size_t block_row, std::size_t block_column, std::size_t vectors,
                          Real* products) {
  constexpr std::size_t kBlock = WorkSpace<Real>::kBlock;
  const Real* a = rows + block_row * kBlock * kTile;
  const Real* b = rows + block_column * kBlock * kTile;
  Real* block = products + (block_row * (block_row + 1) / 2 + block_column) * kBlock * kBlock;
  if (block_row == block_column) {
    product_block<Rows, true>(d, a, a, vectors, block);
  } else {
    product_block<Rows, false>(d, a, b, vectors, block);
  }
}

/// products += rows rows^T, the lower triangle. Some rows of blocks at a time, which stay in the L1 cache while the
/// columns pass by.
template <class D, typename Real = hn::TFromD<D>>
void add_products(D d, const Real* rows, std::size_t count, std::size_t vectors, Real* products) {
  constexpr std::size_t kBlock = WorkSpace<Real>::kBlock;
  constexpr std::size_t kTogether = 4;
  const std::size_t full = count / kBlock;
  for (std::size_t first = 0; first < full; first += kTogether) {
    const std::size_t end = std::min(first + kTogether, full);
    for (std::size_t column = 0; column < end; ++column) {
      for (std::size_t row = std::max(first, column); row < end; ++row) {
        add_block<kBlock>(d, rows, row, column, vectors, products);
      }
    }
  }
  const auto last = [&](auto rest) HWY_ATTR {
    for (std::size_t column = 0; column <= full; ++column) add_block<rest()>(d, rows, full, column, vectors, products);
  };
  switch (count % kBlock) {
    case 1: return last(std::integral_constant<std::size_t, 1>());
    case 2: return last(std::integral_constant<std::size_t, 2>());
    case 3: return last(std::integral_constant<std::size_t, 3>());
    default: break;
  }
}

/// Adds the products of one output to the gradient and the lower triangle of the normal equations of all parameters.
/// Returns its part of the error.
template <typename Real>
double add_to_normal(const PlacedShape& shape, std::size_t output, const WorkSpace<Real>& space, const Real* products,
                     Real* gradient, Real* normal) {
  constexpr std::size_t kBlock = WorkSpace<Real>::kBlock;
  const PlacedLayer& top = shape.top();
  const auto place = [&](std::size_t row) {  // of a row of the Jacobian in the parameters
    if (row < top.weights) return row;
    const std::size_t k = row - top.weights;
    return k < top.fan_in ? top.weights + output * top.fan_in + k : top.thresholds + output;
  };
  const auto products_of = [&](std::size_t row) {  // with row 0, the others follow in blocks
    const std::size_t block_row = row / kBlock;
    return products + block_row * (block_row + 1) / 2 * kBlock * kBlock + row % kBlock * kBlock;
  };
  const auto in_blocks = [](std::size_t column) { return column / kBlock * kBlock * kBlock + column % kBlock; };
  const std::size_t last = space.rows - 1;
  for (std::size_t i = 0; i < last; ++i) {
    Real* row = normal + place(i) * shape.parameters;
    for (std::size_t j = 0; j <= i; ++j) row[place(j)] += products_of(i)[in_blocks(j)];
    gradient[place(i)] += products_of(last)[in_blocks(i)];
  }
  return 0.5 * double{products_of(last)[in_blocks(last)]};
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_PAPER_JACOBIAN_INL_HPP
