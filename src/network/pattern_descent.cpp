// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "network/pattern_descent.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dermis::network {

template <std::floating_point Real>
PatternDescent<Real>::PatternDescent(NetworkShape shape) : shape_(std::move(shape)) {
  std::size_t units = 0;
  for (const Layer& layer : shape_.layers) {
    first_units_.push_back(units);
    units += layer.units;
  }
  outputs_.resize(units);
  deltas_.resize(units);
}

template <std::floating_point Real>
void PatternDescent<Real>::epoch(const Samples<Real>& samples, std::span<const std::size_t> order, Real rate,
                                 Real momentum, std::span<Real> parameters, std::span<Real> steps) {
  const std::size_t outputs = shape_.outputs();
  const std::size_t first_output = first_units_.back();
  for (const std::size_t p : order) {
    const Real* inputs = &samples.inputs[p * shape_.inputs];
    const Real weight = samples.weights.empty() ? Real{1} : samples.weights[p];
    forward(inputs, parameters.data());
    for (std::size_t k = 0; k < outputs; ++k) {
      deltas_[first_output + k] = weight * (outputs_[first_output + k] - samples.targets[p * outputs + k]);
    }
    backward(inputs, rate, momentum, parameters.data(), steps.data());
  }
}

template <std::floating_point Real>
void PatternDescent<Real>::forward(const Real* inputs, const Real* parameters) {
  const Real* below = inputs;
  for (std::size_t layer = 0; layer < shape_.layers.size(); ++layer) {
    const std::size_t fan_in = shape_.fan_in(layer);
    const Real* weights = parameters;
    const Real* thresholds = weights + shape_.layers[layer].units * fan_in;
    Real* outputs = &outputs_[first_units_[layer]];
    for (std::size_t unit = 0; unit < shape_.layers[layer].units; ++unit) {
      const Real sum = std::inner_product(below, below + fan_in, weights + unit * fan_in, thresholds[unit]);
      outputs[unit] = activate(shape_.layers[layer].activation, sum);
    }
    below = outputs;
    parameters = thresholds + shape_.layers[layer].units;
  }
}

template <std::floating_point Real>
void PatternDescent<Real>::backward(const Real* inputs, Real rate, Real momentum, Real* parameters, Real* steps) {
  for (std::size_t layer = shape_.layers.size(); layer-- > 0;) {
    const std::size_t units = shape_.layers[layer].units;
    const std::size_t fan_in = shape_.fan_in(layer);
    const Real* below = layer == 0 ? inputs : &outputs_[first_units_[layer - 1]];
    Real* below_deltas = layer == 0 ? nullptr : &deltas_[first_units_[layer - 1]];
    if (below_deltas != nullptr) std::fill_n(below_deltas, fan_in, Real{0});
    const auto move = [&](std::size_t k, Real derivative) {
      steps[k] = momentum * steps[k] - rate * derivative;
      parameters[k] += steps[k];
    };
    for (std::size_t unit = 0; unit < units; ++unit) {
      const std::size_t neuron = first_units_[layer] + unit;
      const Real delta = deltas_[neuron] * slope_from_output(shape_.layers[layer].activation, outputs_[neuron]);
      const std::size_t weights = shape_.weights(layer) + unit * fan_in;
      for (std::size_t k = 0; k < fan_in; ++k) {
        if (below_deltas != nullptr) below_deltas[k] += delta * parameters[weights + k];
        move(weights + k, delta * below[k]);
      }
      move(shape_.thresholds(layer) + unit, delta);
    }
  }
}

template class PatternDescent<float>;
template class PatternDescent<double>;

}  // namespace dermis::network
