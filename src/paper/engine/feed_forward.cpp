// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/feed_forward.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "paper/engine/feed_forward_kernels.hpp"

// Blocks of vectors are arrays, which vectors without a fixed length cannot be in.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/engine/feed_forward.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "paper/engine/backward-inl.hpp"
#include "paper/engine/forward-inl.hpp"
#include "paper/engine/jacobian-inl.hpp"
#include "paper/engine/lanes-inl.hpp"
#include "paper/engine/transpose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls body(inputs, targets, weights, vectors) for each tile.
template <class D, typename Real, class Body>
HWY_INLINE void for_each_tile(D d, const PlacedShape& shape, const Real* tiles, std::size_t count, const Body& body) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  for (std::size_t first = 0; first < count; first += kTile) {
    const std::size_t vectors = (std::min(count - first, kTile) + kLanes - 1) / kLanes;
    const Real* targets = tiles + shape.inputs * kTile;
    body(tiles, targets, targets + shape.outputs() * kTile, vectors);
    tiles += packed_rows(shape) * kTile;
  }
}

template <typename Real>
void pack(const PlacedShape& shape, const Samples<Real>& samples, std::span<const std::size_t> indices, Real* tiles) {
  for (std::size_t first = 0; first < indices.size(); first += kTile) {
    const std::size_t count = std::min(indices.size() - first, kTile);
    const auto pattern = [&](std::size_t p) { return indices[first + std::min(p, count - 1)]; };
    const auto input = [&](std::size_t p) { return samples.inputs.data() + pattern(p) * shape.inputs; };
    const auto target = [&](std::size_t p) { return samples.targets.data() + pattern(p) * shape.outputs(); };
    to_columns(shape.inputs, kTile, input, tiles);
    to_columns(shape.outputs(), kTile, target, tiles + shape.inputs * kTile);
    Real* weights = tiles + (shape.inputs + shape.outputs()) * kTile;
    for (std::size_t p = 0; p < count; ++p)
      weights[p] = samples.weights.empty() ? Real{1} : samples.weights[pattern(p)];
    std::fill(weights + count, weights + kTile, Real{0});
    tiles += packed_rows(shape) * kTile;
  }
}

template <typename Real>
void evaluate(const PlacedShape& shape, const Real* parameters, const Real* inputs, std::size_t count, Real* outputs,
              Real* work) {
  const Lanes<Real> d;
  const WorkSpace<Real> space(shape);
  prepare(shape, parameters, work + space.prepared);
  for (std::size_t first = 0; first < count; first += kTile) {
    const std::size_t in_tile = std::min(count - first, kTile);
    const std::size_t vectors = (in_tile + hn::MaxLanes(d) - 1) / hn::MaxLanes(d);
    const auto row = [&](std::size_t p) { return inputs + (first + p) * shape.inputs; };
    to_columns(shape.inputs, in_tile, row, work + space.inputs);
    const Real* top = forward(d, shape, work + space.prepared, work + space.inputs, vectors, work + space.outputs);
    to_rows(shape.outputs(), in_tile, top, outputs + first * shape.outputs());
  }
}

template <typename Real>
double error(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count, Real* work) {
  const Lanes<Real> d;
  const WorkSpace<Real> space(shape);
  prepare(shape, parameters, work + space.prepared);
  double sum = 0.0;
  for_each_tile(d, shape, tiles, count,
                [&](const Real* inputs, const Real* targets, const Real* weights, std::size_t vectors) HWY_ATTR {
                  const Real* top = forward(d, shape, work + space.prepared, inputs, vectors, work + space.outputs);
                  sum += output_error(d, shape.top(), top, targets, weights, vectors, static_cast<Real*>(nullptr));
                });
  return sum;
}

template <typename Real>
double error_and_gradient(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count,
                          Real* gradient, Real* work) {
  const Lanes<Real> d;
  const WorkSpace<Real> space(shape);
  prepare(shape, parameters, work + space.prepared);
  Real* sums = work + space.sums;
  std::fill_n(sums, shape.parameters * space.kLine, Real{0});
  double error = 0.0;
  for_each_tile(d, shape, tiles, count,
                [&](const Real* inputs, const Real* targets, const Real* weights, std::size_t vectors) HWY_ATTR {
                  const Real* top = forward(d, shape, work + space.prepared, inputs, vectors, work + space.outputs);
                  error += output_error(d, shape.top(), top, targets, weights, vectors, work + space.deltas[0]);
                  backward(d, shape, parameters, inputs, vectors, space, work);
                });
  for (std::size_t k = 0; k < shape.parameters; ++k) {
    gradient[k] = hn::GetLane(hn::SumOfLanes(d, hn::Load(d, sums + k * space.kLine)));
  }
  return error;
}

template <typename Real>
double normal_equations(const PlacedShape& shape, const Real* parameters, const Real* tiles, std::size_t count,
                        Real* gradient, Real* normal, Real* work) {
  const Lanes<Real> d;
  const WorkSpace<Real> space(shape);
  prepare(shape, parameters, work + space.prepared);
  std::fill_n(gradient, shape.parameters, Real{0});
  std::fill_n(normal, shape.parameters * shape.parameters, Real{0});
  double error = 0.0;
  for (std::size_t output = 0; output < shape.outputs(); ++output) {
    std::fill(work + space.products, work + space.normal_size, Real{0});
    for_each_tile(d, shape, tiles, count,
                  [&](const Real* inputs, const Real* targets, const Real* weights, std::size_t vectors) HWY_ATTR {
                    forward(d, shape, work + space.prepared, inputs, vectors, work + space.outputs);
                    jacobian_rows(d, shape, output, parameters, inputs, targets, weights, vectors, space, work);
                    add_products(d, work + space.jacobian, space.rows, vectors, work + space.products);
                  });
    error += add_to_normal(shape, output, space, work + space.products, gradient, normal);
  }
  for (std::size_t i = 0; i < shape.parameters; ++i) {
    for (std::size_t j = 0; j < i; ++j) normal[j * shape.parameters + i] = normal[i * shape.parameters + j];
  }
  return error;
}

template <typename Real>
FeedForwardKernels<Real> kernels() {
  return {&pack<Real>, &evaluate<Real>, &error<Real>, &error_and_gradient<Real>, &normal_equations<Real>};
}

FeedForwardKernels<float> float_kernels() {
  return kernels<float>();
}
FeedForwardKernels<double> double_kernels() {
  return kernels<double>();
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(float_kernels);
HWY_EXPORT(double_kernels);

namespace {

template <typename Real>
FeedForwardKernels<Real> kernels() {
  if constexpr (std::is_same_v<Real, float>) {
    return HWY_DYNAMIC_DISPATCH(float_kernels)();
  } else {
    return HWY_DYNAMIC_DISPATCH(double_kernels)();
  }
}

/// The values of a vector of cache lines that holds at least `size` of them.
template <typename Line>
auto* grow(std::vector<Line>& lines, std::size_t size) {
  constexpr std::size_t kLine = sizeof(Line) / sizeof(Line::values[0]);
  const std::size_t needed = (size + kLine - 1) / kLine;
  if (lines.size() < needed) lines.resize(needed);
  return lines.data()->values;
}

}  // namespace

template <std::floating_point Real>
PackedSamples<Real>::PackedSamples(const NetworkShape& shape, const Samples<Real>& samples) {
  std::vector<std::size_t> all(samples.count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  pack(shape, samples, all);
}

template <std::floating_point Real>
void PackedSamples<Real>::pack(const NetworkShape& shape, const Samples<Real>& samples,
                               std::span<const std::size_t> indices) {
  const PlacedShape placed(shape);
  const std::size_t tiles = (indices.size() + kTile - 1) / kTile;
  count_ = indices.size();
  rows_ = packed_rows(placed);
  if (count_ == 0) return;
  kernels<Real>().pack(placed, samples, indices, grow(tiles_, tiles * rows_ * kTile));
}

template <std::floating_point Real>
const Real* PackedSamples<Real>::tiles() const noexcept {
  return tiles_.empty() ? nullptr : tiles_.data()->values;
}

template <std::floating_point Real>
FeedForward<Real>::FeedForward(NetworkShape shape) : shape_(std::move(shape)) {
  assert(shape_.validate());
}

template <std::floating_point Real>
void FeedForward<Real>::evaluate(std::span<const Real> parameters, std::span<const Real> inputs,
                                 std::span<Real> outputs) {
  const PlacedShape shape(shape_);
  const std::size_t count = inputs.size() / shape.inputs;
  assert(parameters.size() == shape.parameters && outputs.size() == count * shape.outputs());
  Real* work = grow(work_, WorkSpace<Real>(shape).evaluate_size);
  kernels<Real>().evaluate(shape, parameters.data(), inputs.data(), count, outputs.data(), work);
}

template <std::floating_point Real>
double FeedForward<Real>::error(std::span<const Real> parameters, const PackedSamples<Real>& samples) {
  const PlacedShape shape(shape_);
  assert(parameters.size() == shape.parameters && samples.rows_ == packed_rows(shape));
  Real* work = grow(work_, WorkSpace<Real>(shape).evaluate_size);
  return kernels<Real>().error(shape, parameters.data(), samples.tiles(), samples.count(), work);
}

template <std::floating_point Real>
double FeedForward<Real>::error_and_gradient(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                                             std::span<Real> gradient) {
  const PlacedShape shape(shape_);
  assert(parameters.size() == shape.parameters && samples.rows_ == packed_rows(shape));
  assert(gradient.size() == shape.parameters);
  Real* work = grow(work_, WorkSpace<Real>(shape).gradient_size);
  return kernels<Real>().error_and_gradient(shape, parameters.data(), samples.tiles(), samples.count(), gradient.data(),
                                            work);
}

template <std::floating_point Real>
double FeedForward<Real>::normal_equations(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                                           std::span<Real> gradient, std::span<Real> normal) {
  const PlacedShape shape(shape_);
  assert(parameters.size() == shape.parameters && samples.rows_ == packed_rows(shape));
  assert(gradient.size() == shape.parameters && normal.size() == shape.parameters * shape.parameters);
  Real* work = grow(work_, WorkSpace<Real>(shape).normal_size);
  return kernels<Real>().normal_equations(shape, parameters.data(), samples.tiles(), samples.count(), gradient.data(),
                                          normal.data(), work);
}

template class PackedSamples<float>;
template class PackedSamples<double>;
template class FeedForward<float>;
template class FeedForward<double>;

}  // namespace dermis::paper
#endif
