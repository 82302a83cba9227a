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
#include "network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using network::HWY_NAMESPACE::kLogSigmoidPower;
using network::HWY_NAMESPACE::kTanhPower;
using network::HWY_NAMESPACE::log_sigmoid_of_power;
using network::HWY_NAMESPACE::tanh_of_power;

template <typename Real>
using Lanes = hn::CappedTag<Real, kCacheLineBytes / sizeof(Real)>;

/// Vectors that a kernel works on at a time: sums and what they are made of fit the registers.
constexpr std::size_t kVectors = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM ? 4 : 2;

/// Calls body(0) ... body(Count - 1) with constants, so that what they index stays in registers.
template <std::size_t Count, class Body>
HWY_INLINE void unroll(const Body& body) {
  const auto call = [&]<std::size_t... K>(std::index_sequence<K...>)
                        HWY_ATTR { (body(std::integral_constant<std::size_t, K>()), ...); };
  call(std::make_index_sequence<Count>());
}

/// Calls body(first, std::integral_constant<n>) for first = 0, AtOnce, ...; n = AtOnce, for the rest 1.
template <std::size_t AtOnce, class Body>
HWY_INLINE void in_blocks(std::size_t count, const Body& body) {
  std::size_t first = 0;
  for (; first + AtOnce <= count; first += AtOnce) body(first, std::integral_constant<std::size_t, AtOnce>());
  for (; first < count; ++first) body(first, std::integral_constant<std::size_t, 1>());
}

// ---- rows <-> columns ----

#if HWY_TARGET == HWY_SCALAR
template <typename Real>
constexpr std::size_t kSquare = 1;

template <typename Real>
HWY_INLINE void transpose_square(const Real* const (&in)[1], Real* const (&out)[1]) {
  *out[0] = *in[0];
}
#else
/// Rows and columns that fill 128 bits: shuffles within them are cheap everywhere.
template <typename Real>
constexpr std::size_t kSquare = 16 / sizeof(Real);

HWY_INLINE void transpose_square(const float* const (&in)[4], float* const (&out)[4]) {
  const hn::FixedTag<float, 4> d;
  const hn::FixedTag<double, 2> pairs;
  const auto interleave = [d, pairs](const float* above, const float* below, auto& low, auto& high) HWY_ATTR {
    const auto a = hn::LoadU(d, above);
    const auto b = hn::LoadU(d, below);
    low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    high = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
  };
  hn::Vec<decltype(pairs)> low01;
  hn::Vec<decltype(pairs)> high01;
  hn::Vec<decltype(pairs)> low23;
  hn::Vec<decltype(pairs)> high23;
  interleave(in[0], in[1], low01, high01);
  interleave(in[2], in[3], low23, high23);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)), d, out[0]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)), d, out[1]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)), d, out[2]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23)), d, out[3]);
}

HWY_INLINE void transpose_square(const double* const (&in)[2], double* const (&out)[2]) {
  const hn::FixedTag<double, 2> d;
  const auto a = hn::LoadU(d, in[0]);
  const auto b = hn::LoadU(d, in[1]);
  hn::StoreU(hn::InterleaveLower(d, a, b), d, out[0]);
  hn::StoreU(hn::InterleaveUpper(d, a, b), d, out[1]);
}
#endif

/// in(row) [columns] -> out(column) [rows].
template <typename Real, class In, class Out>
HWY_INLINE void transpose(std::size_t rows, std::size_t columns, const In& in, const Out& out) {
  constexpr std::size_t kSide = kSquare<Real>;
  const auto one = [&](std::size_t row, std::size_t column) HWY_ATTR { out(column)[row] = in(row)[column]; };
  std::size_t row = 0;
  for (; row + kSide <= rows; row += kSide) {
    std::size_t column = 0;
    for (; column + kSide <= columns; column += kSide) {
      const Real* from[kSide];
      Real* to[kSide];
      unroll<kSide>([&](auto k) HWY_ATTR {
        from[k] = in(row + k) + column;
        to[k] = out(column + k) + row;
      });
      transpose_square(from, to);
    }
    for (; column < columns; ++column) unroll<kSide>([&](auto k) HWY_ATTR { one(row + k, column); });
  }
  for (; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) one(row, column);
  }
}

/// rows(p) points to `columns` values of sample p -> out [columns, kTile], samples 0 ... count - 1.
template <typename Real, class Rows>
HWY_INLINE void to_columns(std::size_t columns, std::size_t count, const Rows& rows, Real* out) {
  transpose<Real>(count, columns, rows, [out](std::size_t k) HWY_ATTR { return out + k * kTile; });
}

/// in [columns, kTile] -> out [count, columns].
template <typename Real>
HWY_INLINE void to_rows(std::size_t columns, std::size_t count, const Real* in, Real* out) {
  if (columns == 1) {
    std::copy_n(in, count, out);
    return;
  }
  transpose<Real>(
      columns, count, [in](std::size_t k) HWY_ATTR { return in + k * kTile; },
      [out, columns](std::size_t p) HWY_ATTR { return out + p * columns; });
}

// ---- forward ----

double power_scale(Activation activation) {
  switch (activation) {
    case Activation::log_sigmoid: return kLogSigmoidPower;
    case Activation::tanh: return kTanhPower;
    case Activation::relu:
    case Activation::linear: break;
  }
  return 1.0;
}

/// The parameters, those of each layer scaled as its activation function wants them.
template <typename Real>
void prepare(const PlacedShape& shape, const Real* parameters, Real* prepared) {
  for (std::size_t l = 0; l < shape.layer_count; ++l) {
    const PlacedLayer& layer = shape.layers[l];
    const auto scale = static_cast<Real>(power_scale(layer.activation));
    const std::size_t end = layer.thresholds + layer.units;
    for (std::size_t k = layer.weights; k < end; ++k) prepared[k] = scale * parameters[k];
  }
}

/// The outputs of neurons, from their scaled sums, in place.
template <std::size_t Count, class D>
HWY_INLINE void activate_all(D d, Activation activation, hn::Vec<D> (&values)[Count]) {
  switch (activation) {
    case Activation::log_sigmoid:
      unroll<Count>([&](auto k) HWY_ATTR { values[k] = log_sigmoid_of_power(d, values[k]); });
      break;
    case Activation::tanh: unroll<Count>([&](auto k) HWY_ATTR { values[k] = tanh_of_power(d, values[k]); }); break;
    case Activation::relu:
      unroll<Count>([&](auto k)
                        HWY_ATTR { values[k] = hn::IfThenZeroElse(hn::Lt(values[k], hn::Zero(d)), values[k]); });
      break;
    case Activation::linear: break;
  }
}

/// Eq. (4) for Units neurons and Count vectors of samples.
template <std::size_t Units, std::size_t Count, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void forward_block(D d, const PlacedLayer& layer, const Real* prepared, std::size_t unit, const Real* below,
                              Real* outputs) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  hn::Vec<D> sums[Units * Count];
  unroll<Units>([&](auto u) HWY_ATTR {
    const auto threshold = hn::Set(d, prepared[layer.thresholds + unit + u]);
    unroll<Count>([&](auto v) HWY_ATTR { sums[u * Count + v] = threshold; });
  });
  const Real* weights = prepared + layer.weights + unit * layer.fan_in;
  for (std::size_t k = 0; k < layer.fan_in; ++k) {
    hn::Vec<D> x[Count];
    unroll<Count>([&](auto v) HWY_ATTR { x[v] = hn::Load(d, below + k * kTile + v * kLanes); });
    unroll<Units>([&](auto u) HWY_ATTR {
      const auto weight = hn::Set(d, weights[u * layer.fan_in + k]);
      unroll<Count>([&](auto v) HWY_ATTR { sums[u * Count + v] = hn::MulAdd(weight, x[v], sums[u * Count + v]); });
    });
  }
  activate_all(d, layer.activation, sums);
  unroll<Units>([&](auto u) HWY_ATTR {
    unroll<Count>([&](auto v)
                      HWY_ATTR { hn::Store(sums[u * Count + v], d, outputs + (unit + u) * kTile + v * kLanes); });
  });
}

/// The outputs of all layers [units, kTile] for `vectors` vectors of samples; returns those of the output layer.
template <class D, typename Real = hn::TFromD<D>>
const Real* forward(D d, const PlacedShape& shape, const Real* prepared, const Real* inputs, std::size_t vectors,
                    Real* outputs) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const Real* below = inputs;
  for (std::size_t l = 0; l < shape.layer_count; ++l) {
    const PlacedLayer& layer = shape.layers[l];
    Real* layer_outputs = outputs + layer.first_unit * kTile;
    in_blocks<4>(layer.units, [&](std::size_t unit, auto units) HWY_ATTR {
      in_blocks<kVectors>(vectors, [&](std::size_t v, auto count) HWY_ATTR {
        forward_block<units(), count()>(d, layer, prepared, unit, below + v * kLanes, layer_outputs + v * kLanes);
      });
    });
    below = layer_outputs;
  }
  return below;
}

// ---- backward ----

/// dE/dsum of a neuron from dE/doutput and its output.
template <class D>
HWY_INLINE hn::Vec<D> through(D d, Activation activation, hn::Vec<D> delta, hn::Vec<D> output) {
  switch (activation) {
    case Activation::log_sigmoid: {
      const auto product = hn::Mul(delta, output);
      return hn::NegMulAdd(product, output, product);
    }
    case Activation::tanh: return hn::NegMulAdd(hn::Mul(delta, output), output, delta);
    case Activation::relu: return hn::IfThenElseZero(hn::Gt(output, hn::Zero(d)), delta);
    case Activation::linear: break;
  }
  return delta;
}

/// The same for many, in place.
template <std::size_t Count, class D>
HWY_INLINE void through_all(D d, Activation activation, hn::Vec<D> (&deltas)[Count],
                            const hn::Vec<D> (&outputs)[Count]) {
  const auto all = [&](auto constant) HWY_ATTR {
    unroll<Count>([&](auto k) HWY_ATTR { deltas[k] = through(d, constant(), deltas[k], outputs[k]); });
  };
  switch (activation) {  // outside the unrolled loop
    case Activation::log_sigmoid: return all(std::integral_constant<Activation, Activation::log_sigmoid>());
    case Activation::tanh: return all(std::integral_constant<Activation, Activation::tanh>());
    case Activation::relu: return all(std::integral_constant<Activation, Activation::relu>());
    case Activation::linear: break;
  }
}

/// Half the weighted squares of a tile, and dE/dsum of the output layer where `deltas` is not null. Lanes are summed
/// in double precision: a long sum of floats would drift.
template <class D, typename Real = hn::TFromD<D>>
double output_error(D d, const PlacedLayer& top, const Real* outputs, const Real* targets, const Real* weights,
                    std::size_t vectors, Real* deltas) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  auto sum = hn::Zero(d);
  for (std::size_t k = 0; k < top.units; ++k) {
    for (std::size_t v = 0; v < vectors; ++v) {
      const std::size_t place = k * kTile + v * kLanes;
      const auto output = hn::Load(d, outputs + place);
      const auto difference = hn::Sub(output, hn::Load(d, targets + place));
      const auto weighted = hn::Mul(difference, hn::Load(d, weights + v * kLanes));
      sum = hn::MulAdd(weighted, difference, sum);
      if (deltas != nullptr) hn::Store(through(d, top.activation, weighted, output), d, deltas + place);
    }
  }
  alignas(kCacheLineBytes) Real lanes[kLanes];
  hn::Store(sum, d, lanes);
  double error = 0.0;
  for (const Real lane : lanes) error += double{lane};
  return 0.5 * error;
}

/// sums [Units, fan_in, kLine] of Units neurons += delta times what is below, for inputs k ... k + Inputs - 1.
template <std::size_t Units, std::size_t Inputs, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void weight_gradient_block(D d, const Real* deltas, const Real* below, std::size_t vectors,
                                      std::size_t fan_in, Real* sums) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  hn::Vec<D> block[Units * Inputs];
  unroll<Units * Inputs>([&](auto k) HWY_ATTR { block[k] = hn::Zero(d); });
  for (std::size_t v = 0; v < vectors; ++v) {
    hn::Vec<D> delta[Units];
    unroll<Units>([&](auto u) HWY_ATTR { delta[u] = hn::Load(d, deltas + u * kTile + v * kLanes); });
    unroll<Inputs>([&](auto k) HWY_ATTR {
      const auto x = hn::Load(d, below + k * kTile + v * kLanes);
      unroll<Units>([&](auto u) HWY_ATTR { block[u * Inputs + k] = hn::MulAdd(delta[u], x, block[u * Inputs + k]); });
    });
  }
  unroll<Units>([&](auto u) HWY_ATTR {
    unroll<Inputs>([&](auto k) HWY_ATTR {
      Real* sum = sums + (u * fan_in + k) * WorkSpace<Real>::kLine;
      hn::Store(hn::Add(hn::Load(d, sum), block[u * Inputs + k]), d, sum);
    });
  });
}

template <class D, typename Real = hn::TFromD<D>>
void threshold_gradient(D d, const PlacedLayer& layer, const Real* deltas, std::size_t vectors, Real* sums) {
  for (std::size_t unit = 0; unit < layer.units; ++unit) {
    auto total = hn::Zero(d);
    for (std::size_t v = 0; v < vectors; ++v) {
      total = hn::Add(total, hn::Load(d, deltas + unit * kTile + v * hn::MaxLanes(d)));
    }
    Real* sum = sums + (layer.thresholds + unit) * WorkSpace<Real>::kLine;
    hn::Store(hn::Add(hn::Load(d, sum), total), d, sum);
  }
}

template <class D, typename Real = hn::TFromD<D>>
void layer_gradient(D d, const PlacedLayer& layer, const Real* deltas, const Real* below, std::size_t vectors,
                    Real* sums) {
  in_blocks<4>(layer.units, [&](std::size_t unit, auto units) HWY_ATTR {
    in_blocks<kVectors>(layer.fan_in, [&](std::size_t k, auto inputs) HWY_ATTR {
      const std::size_t first = layer.weights + unit * layer.fan_in + k;
      weight_gradient_block<units(), inputs()>(d, deltas + unit * kTile, below + k * kTile, vectors, layer.fan_in,
                                               sums + first * WorkSpace<Real>::kLine);
    });
  });
  threshold_gradient(d, layer, deltas, vectors, sums);
}

/// dE/dsum of Units neurons of the layer below, whose outputs are `outputs`, for Count vectors of samples.
template <std::size_t Units, std::size_t Count, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void deltas_block(D d, const Real* weights, const PlacedLayer& layer, Activation activation_below,
                             const Real* deltas, const Real* outputs, Real* deltas_below) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  hn::Vec<D> sums[Units * Count];
  unroll<Units * Count>([&](auto k) HWY_ATTR { sums[k] = hn::Zero(d); });
  for (std::size_t above = 0; above < layer.units; ++above) {
    hn::Vec<D> delta[Count];
    unroll<Count>([&](auto v) HWY_ATTR { delta[v] = hn::Load(d, deltas + above * kTile + v * kLanes); });
    unroll<Units>([&](auto u) HWY_ATTR {
      const auto weight = hn::Set(d, weights[above * layer.fan_in + u]);
      unroll<Count>([&](auto v) HWY_ATTR { sums[u * Count + v] = hn::MulAdd(weight, delta[v], sums[u * Count + v]); });
    });
  }
  hn::Vec<D> y[Units * Count];
  unroll<Units * Count>([&](auto k) HWY_ATTR { y[k] = hn::Load(d, outputs + k / Count * kTile + k % Count * kLanes); });
  through_all(d, activation_below, sums, y);
  unroll<Units * Count>([&](auto k)
                            HWY_ATTR { hn::Store(sums[k], d, deltas_below + k / Count * kTile + k % Count * kLanes); });
}

template <class D, typename Real = hn::TFromD<D>>
void layer_deltas(D d, const PlacedLayer& layer, const PlacedLayer& below, const Real* weights, const Real* deltas,
                  const Real* outputs, std::size_t vectors, Real* deltas_below) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  in_blocks<4>(below.units, [&](std::size_t unit, auto units) HWY_ATTR {
    in_blocks<kVectors>(vectors, [&](std::size_t v, auto count) HWY_ATTR {
      const std::size_t place = unit * kTile + v * kLanes;
      deltas_block<units(), count()>(d, weights + unit, layer, below.activation, deltas + v * kLanes,
                                     outputs + below.first_unit * kTile + place, deltas_below + place);
    });
  });
}

/// A network of one hidden layer on few inputs with one output, as in Fig. 5 of the paper: the gradient of both layers
/// in one pass over the hidden neurons unit ... unit + Units - 1, whose deltas are never stored. The weight between
/// output and hidden neuron is common to all samples: it multiplies the sums.
template <std::size_t Units, std::size_t Inputs, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void one_output_block(D d, const PlacedShape& shape, std::size_t unit, const Real* parameters,
                                 const Real* inputs, const Real* outputs, const Real* deltas, std::size_t vectors,
                                 Real* sums) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  constexpr std::size_t kLine = WorkSpace<Real>::kLine;
  const PlacedLayer& hidden = shape.layers[0];
  hn::Vec<D> top[Units];
  hn::Vec<D> threshold[Units];
  hn::Vec<D> weight[Units * Inputs];
  unroll<Units>([&](auto u) HWY_ATTR { top[u] = threshold[u] = hn::Zero(d); });
  unroll<Units * Inputs>([&](auto k) HWY_ATTR { weight[k] = hn::Zero(d); });
  for (std::size_t v = 0; v < vectors; ++v) {
    const auto delta = hn::Load(d, deltas + v * kLanes);
    hn::Vec<D> y[Units];
    hn::Vec<D> back[Units];
    unroll<Units>([&](auto u) HWY_ATTR {
      y[u] = hn::Load(d, outputs + (unit + u) * kTile + v * kLanes);
      top[u] = hn::MulAdd(delta, y[u], top[u]);
      back[u] = delta;
    });
    through_all(d, hidden.activation, back, y);
    unroll<Units>([&](auto u) HWY_ATTR { threshold[u] = hn::Add(threshold[u], back[u]); });
    unroll<Inputs>([&](auto k) HWY_ATTR {
      const auto x = hn::Load(d, inputs + k * kTile + v * kLanes);
      unroll<Units>([&](auto u) HWY_ATTR { weight[u * Inputs + k] = hn::MulAdd(back[u], x, weight[u * Inputs + k]); });
    });
  }
  const auto add = [&](std::size_t parameter, auto factor, auto sum) HWY_ATTR {
    Real* place = sums + parameter * kLine;
    hn::Store(hn::MulAdd(factor, sum, hn::Load(d, place)), d, place);
  };
  unroll<Units>([&](auto u) HWY_ATTR {
    const std::size_t above = shape.top().weights + unit + u;
    const auto factor = hn::Set(d, parameters[above]);
    add(above, hn::Set(d, Real{1}), top[u]);
    add(hidden.thresholds + unit + u, factor, threshold[u]);
    unroll<Inputs>([&](auto k)
                       HWY_ATTR { add(hidden.weights + (unit + u) * Inputs + k, factor, weight[u * Inputs + k]); });
  });
}

template <std::size_t Inputs, class D, typename Real = hn::TFromD<D>>
void one_output_gradient(D d, const PlacedShape& shape, const Real* parameters, const Real* inputs, const Real* outputs,
                         const Real* deltas, std::size_t vectors, Real* sums) {
  in_blocks<kVectors>(shape.layers[0].units, [&](std::size_t unit, auto units) HWY_ATTR {
    one_output_block<units(), Inputs>(d, shape, unit, parameters, inputs, outputs, deltas, vectors, sums);
  });
}

// ---- a pass over all tiles ----

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

/// The backward pass of Fig. 9 for one tile; deltas[0] holds those of the output layer.
template <class D, typename Real = hn::TFromD<D>>
void backward(D d, const PlacedShape& shape, const Real* parameters, const Real* inputs, std::size_t vectors,
              const WorkSpace<Real>& space, Real* work) {
  Real* deltas = work + space.deltas[0];
  Real* deltas_below = work + space.deltas[1];
  const Real* outputs = work + space.outputs;
  if (shape.layer_count == 2 && shape.outputs() == 1 && shape.inputs <= 4) {
    Real* sums = work + space.sums;
    threshold_gradient(d, shape.top(), deltas, vectors, sums);
    switch (shape.inputs) {
      case 1: return one_output_gradient<1>(d, shape, parameters, inputs, outputs, deltas, vectors, sums);
      case 2: return one_output_gradient<2>(d, shape, parameters, inputs, outputs, deltas, vectors, sums);
      case 3: return one_output_gradient<3>(d, shape, parameters, inputs, outputs, deltas, vectors, sums);
      default: return one_output_gradient<4>(d, shape, parameters, inputs, outputs, deltas, vectors, sums);
    }
  }
  for (std::size_t l = shape.layer_count - 1; l > 0; --l) {
    const PlacedLayer& layer = shape.layers[l];
    const PlacedLayer& below = shape.layers[l - 1];
    layer_gradient(d, layer, deltas, outputs + below.first_unit * kTile, vectors, work + space.sums);
    layer_deltas(d, layer, below, parameters + layer.weights, deltas, outputs, vectors, deltas_below);
    std::swap(deltas, deltas_below);
  }
  layer_gradient(d, shape.layers[0], deltas, inputs, vectors, work + space.sums);
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

// ---- normal equations ----

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

/// The rows of one output's Jacobian for a tile, each sample times the root of its weight: parameters of the lower
/// layers, weights and threshold of the output, and as the last row the residual. The derivatives by the thresholds are
/// the deltas, so these are made in place.
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

/// Adds the products of one output to the gradient and the lower triangle of the normal equations of all parameters;
/// returns its part of the error.
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
