// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/training/pattern_descent.hpp"

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/training/pattern_descent.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using touch::network::HWY_NAMESPACE::activate;
using touch::network::HWY_NAMESPACE::slope_from_output;

/// Networks whose rows all end within so many lanes are walked through in vectors of no more: sums over the lanes then
/// take fewer steps.
constexpr std::size_t kFewLanes = 8;
constexpr std::size_t kManyLanes = 16;

/// Gradient descent in vectors of D.
template <class D>
class Walker {
 public:
  using Real = hn::TFromD<D>;
  using Vector = hn::Vec<D>;

  Walker(std::span<const LaneLayer<Real>> layers, const PatternWalk<Real>& walk)
      : layers_(layers), walk_(walk), rate_(hn::Set(d_, walk.rate)), momentum_(hn::Set(d_, walk.momentum)) {}

  void run() const {
    const std::size_t inputs = layers_.front().fan_in;
    for (const std::size_t p : walk_.order) {
      const Real* pattern = &walk_.samples.inputs[p * inputs];
      for (std::size_t k = 0; k < layers_.size(); ++k) evaluate(layers_[k], below(k, pattern));
      set_output_deltas(p);
      for (std::size_t k = layers_.size(); k-- > 0;) {
        move(layers_[k], below(k, pattern), k == 0 ? nullptr : layers_[k - 1].deltas);
      }
    }
  }

 private:
  [[nodiscard]] const Real* below(std::size_t layer, const Real* pattern) const {
    return layer == 0 ? pattern : layers_[layer - 1].outputs;
  }

  void evaluate(const LaneLayer<Real>& layer, const Real* inputs) const {
    layer.units_in_lanes ? evaluate_units(layer, inputs) : evaluate_each_unit(layer, inputs);
  }

  void evaluate_units(const LaneLayer<Real>& layer, const Real* inputs) const {
    for (std::size_t first = 0; first < layer.units; first += kLanes) {
      const Real* weights = layer.weights + first;
      Vector sum = hn::Load(d_, weights + layer.fan_in * layer.row);
      for (std::size_t k = 0; k < layer.fan_in; ++k, weights += layer.row) {
        sum = hn::MulAdd(hn::Set(d_, inputs[k]), hn::Load(d_, weights), sum);
      }
      const Vector output = activate(d_, layer.activation, sum);
      hn::Store(hn::IfThenElse(hn::FirstN(d_, layer.units - first), output, end_of_row(layer.units - first)), d_,
                layer.outputs + first);
    }
  }

  /// 1 in the lane `units`, 0 elsewhere.
  Vector end_of_row(std::size_t units) const {
    const auto is_one = hn::Eq(hn::Iota(d_, Real{0}), hn::Set(d_, static_cast<Real>(units)));
    return hn::IfThenElseZero(is_one, hn::Set(d_, Real{1}));
  }

  void evaluate_each_unit(const LaneLayer<Real>& layer, const Real* inputs) const {
    for (std::size_t unit = 0; unit < layer.units; ++unit) {
      const Real* weights = layer.weights + unit * layer.row;
      Vector sum = hn::Zero(d_);
      for (std::size_t k = 0; k < layer.columns(); k += kLanes) {
        sum = hn::MulAdd(hn::Load(d_, weights + k), hn::Load(d_, inputs + k), sum);
      }
      layer.outputs[unit] = hn::GetLane(activate(d_, layer.activation, hn::SumOfLanes(d_, sum)));
    }
  }

  void set_output_deltas(std::size_t p) const {
    const LaneLayer<Real>& layer = layers_.back();
    const Real weight = walk_.samples.weights.empty() ? Real{1} : walk_.samples.weights[p];
    const Real* targets = &walk_.samples.targets[p * layer.units];
    for (std::size_t k = 0; k < layer.units; ++k) layer.deltas[k] = weight * (layer.outputs[k] - targets[k]);
  }

  /// From layer.deltas: the step of its weights, and the deltas of the layer below, where there is one.
  void move(const LaneLayer<Real>& layer, const Real* inputs, Real* below_deltas) const {
    layer.units_in_lanes ? move_units(layer, inputs, below_deltas) : move_each_unit(layer, inputs, below_deltas);
  }

  /// `downhill`: - rate times the derivative.
  void move_lanes(Real* weights, Vector weight, Real* steps, Vector downhill) const {
    const Vector step = hn::MulAdd(momentum_, hn::Load(d_, steps), downhill);
    hn::Store(step, d_, steps);
    hn::Store(hn::Add(weight, step), d_, weights);
  }

  void move_units(const LaneLayer<Real>& layer, const Real* inputs, Real* below_deltas) const {
    for (std::size_t first = 0; first < layer.units; first += kLanes) {
      const Vector slope = slope_from_output(d_, layer.activation, hn::Load(d_, layer.outputs + first));
      const Vector delta = hn::Mul(hn::Load(d_, layer.deltas + first), slope);
      hn::Store(hn::IfThenElseZero(hn::FirstN(d_, layer.units - first), delta), d_, layer.deltas + first);
    }
    for (std::size_t k = 0; k <= layer.fan_in; ++k) {
      const Vector input = k == layer.fan_in ? hn::Neg(rate_) : hn::Mul(hn::Neg(rate_), hn::Set(d_, inputs[k]));
      Vector from_above = hn::Zero(d_);
      for (std::size_t first = 0; first < layer.units; first += kLanes) {
        const std::size_t place = k * layer.row + first;
        const Vector weight = hn::Load(d_, layer.weights + place);
        const Vector delta = hn::Load(d_, layer.deltas + first);
        from_above = hn::MulAdd(delta, weight, from_above);
        move_lanes(layer.weights + place, weight, layer.steps + place, hn::Mul(delta, input));
      }
      if (below_deltas != nullptr && k < layer.fan_in) below_deltas[k] = hn::GetLane(hn::SumOfLanes(d_, from_above));
    }
  }

  void move_each_unit(const LaneLayer<Real>& layer, const Real* inputs, Real* below_deltas) const {
    for (std::size_t unit = 0; unit < layer.units; ++unit) {
      const Vector slope = slope_from_output(d_, layer.activation, hn::Set(d_, layer.outputs[unit]));
      const Vector delta = hn::Mul(hn::Set(d_, layer.deltas[unit]), slope);
      const Vector downhill = hn::Mul(hn::Neg(rate_), delta);
      for (std::size_t k = 0; k < layer.columns(); k += kLanes) {
        const std::size_t place = unit * layer.row + k;
        const Vector weight = hn::Load(d_, layer.weights + place);
        const Vector so_far = unit == 0 ? hn::Zero(d_) : hn::Load(d_, below_deltas + k);
        hn::Store(hn::MulAdd(delta, weight, so_far), d_, below_deltas + k);
        move_lanes(layer.weights + place, weight, layer.steps + place, hn::Mul(downhill, hn::Load(d_, inputs + k)));
      }
    }
  }

  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  D d_;
  std::span<const LaneLayer<Real>> layers_;
  const PatternWalk<Real>& walk_;
  Vector rate_;
  Vector momentum_;
};

template <typename Real>
void walk_patterns(std::span<const LaneLayer<Real>> layers, const PatternWalk<Real>& walk) {
  const auto has_few = [](const LaneLayer<Real>& layer) { return layer.columns() <= kFewLanes; };
  // NOLINTNEXTLINE(bugprone-branch-clone): the same only where vectors are short
  if (std::all_of(layers.begin(), layers.end(), has_few)) {
    Walker<hn::CappedTag<Real, kFewLanes>>(layers, walk).run();
  } else {
    Walker<hn::CappedTag<Real, kManyLanes>>(layers, walk).run();
  }
}

void walk_float_patterns(std::span<const LaneLayer<float>> layers, const PatternWalk<float>& walk) {
  walk_patterns(layers, walk);
}
void walk_double_patterns(std::span<const LaneLayer<double>> layers, const PatternWalk<double>& walk) {
  walk_patterns(layers, walk);
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(walk_float_patterns);
HWY_EXPORT(walk_double_patterns);

namespace {

/// Numbers in whole cache lines.
template <typename Real>
constexpr std::size_t in_lines(std::size_t count) {
  constexpr std::size_t kLine = sizeof(CacheLine<Real>) / sizeof(Real);
  return (count + kLine - 1) / kLine * kLine;
}

/// Calls body(place in the lanes, place in the parameters) for each.
template <typename Real, typename Body>
void for_each_parameter(const LaneLayer<Real>& layer, std::size_t& next, const Body& body) {
  for (std::size_t unit = 0; unit < layer.units; ++unit) {
    for (std::size_t input = 0; input < layer.fan_in; ++input) body(layer.place(unit, input), next++);
  }
  for (std::size_t unit = 0; unit < layer.units; ++unit) body(layer.place(unit, layer.fan_in), next++);
}

}  // namespace

template <std::floating_point Real>
PatternDescent<Real>::PatternDescent(const NetworkShape& shape) {
  std::size_t size = 0;
  for (std::size_t k = 0; k < shape.layers.size(); ++k) {
    LaneLayer<Real>& layer = layers_.emplace_back();
    layer.units = shape.layers[k].units;
    layer.fan_in = shape.fan_in(k);
    layer.activation = shape.layers[k].activation;
    layer.units_in_lanes = k == 0 || layer.units > layer.fan_in;
    layer.row = in_lines<Real>(layer.columns());
    size += 2 * layer.rows() * layer.row + 2 * in_lines<Real>(layer.units + 1);
  }
  memory_.resize(size / in_lines<Real>(1));
  Real* next = memory_.data()->values;
  for (LaneLayer<Real>& layer : layers_) {
    layer.weights = next;
    layer.steps = layer.weights + layer.rows() * layer.row;
    layer.outputs = layer.steps + layer.rows() * layer.row;
    layer.deltas = layer.outputs + in_lines<Real>(layer.units + 1);
    next = layer.deltas + in_lines<Real>(layer.units + 1);
    layer.outputs[layer.units] = Real{1};
  }
}

template <std::floating_point Real>
void PatternDescent<Real>::epoch(const PatternWalk<Real>& walk, std::span<Real> parameters, std::span<Real> steps) {
  std::size_t next = 0;
  for (const LaneLayer<Real>& layer : layers_) {
    for_each_parameter(layer, next, [&](std::size_t place, std::size_t k) {
      layer.weights[place] = parameters[k];
      layer.steps[place] = steps[k];
    });
  }
  const std::span<const LaneLayer<Real>> layers = layers_;
  if constexpr (std::is_same_v<Real, float>) {
    HWY_DYNAMIC_DISPATCH(walk_float_patterns)(layers, walk);
  } else {
    HWY_DYNAMIC_DISPATCH(walk_double_patterns)(layers, walk);
  }
  next = 0;
  for (const LaneLayer<Real>& layer : layers_) {
    for_each_parameter(layer, next, [&](std::size_t place, std::size_t k) {
      parameters[k] = layer.weights[place];
      steps[k] = layer.steps[place];
    });
  }
}

template class PatternDescent<float>;
template class PatternDescent<double>;

}  // namespace dermis::paper
#endif
