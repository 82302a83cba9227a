// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The outputs of all neurons, eq. (4) of the paper.
// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_FORWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_FORWARD_INL_HPP
#undef DERMIS_PAPER_FORWARD_INL_HPP
#else
#define DERMIS_PAPER_FORWARD_INL_HPP
#endif

#include <cstddef>

#include "hwy/highway.h"
#include "paper/engine/lanes-inl.hpp"
#include "paper/engine/placed_shape.hpp"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using touch::network::HWY_NAMESPACE::kLogSigmoidPower;
using touch::network::HWY_NAMESPACE::kTanhPower;
using touch::network::HWY_NAMESPACE::log_sigmoid_of_power;
using touch::network::HWY_NAMESPACE::tanh_of_power;

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

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_PAPER_FORWARD_INL_HPP
