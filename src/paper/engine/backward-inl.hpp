// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The derivatives of the error by all parameters: the backward pass of Fig. 9 of the paper.
// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_BACKWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_BACKWARD_INL_HPP
#undef DERMIS_PAPER_BACKWARD_INL_HPP
#else
#define DERMIS_PAPER_BACKWARD_INL_HPP
#endif

#include <cstddef>
#include <type_traits>
#include <utility>

#include "hwy/highway.h"
#include "paper/engine/feed_forward_kernels.hpp"
#include "paper/engine/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

/// A network of one hidden layer on few inputs with one output, as in Fig. 5 of the paper. The gradient of both layers
/// takes one pass over the hidden neurons unit ... unit + Units - 1, whose deltas are never stored. The weight between
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

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_PAPER_BACKWARD_INL_HPP
