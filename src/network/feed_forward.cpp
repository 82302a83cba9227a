// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/feed_forward.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace dermis::network {
namespace {

/// The outputs of every layer for one pattern, one after the other.
template <typename Real>
void forward(const NetworkShape& shape, std::span<const Real> parameters, const Real* inputs, Real* outputs) {
  const Real* below = inputs;
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    const std::size_t fan_in = shape.fan_in(layer);
    const Real* weights = &parameters[shape.weights(layer)];
    const Real* thresholds = &parameters[shape.thresholds(layer)];
    for (std::size_t unit = 0; unit < shape.layers[layer].units; ++unit) {
      const Real sum = std::inner_product(below, below + fan_in, weights + unit * fan_in, thresholds[unit]);
      outputs[unit] = activate(shape.layers[layer].activation, sum);
    }
    below = outputs;
    outputs += shape.layers[layer].units;
  }
}

std::size_t unit_count(const NetworkShape& shape) {
  std::size_t units = 0;
  for (const Layer& layer : shape.layers) units += layer.units;
  return units;
}

/// deltas: at the output layer d error / d output on entry; d error / d sum of every neuron on return.
template <typename Real>
void backward(const NetworkShape& shape, std::span<const Real> parameters, const Real* inputs, const Real* outputs,
              Real* deltas, Real* gradient) {
  std::size_t first = unit_count(shape);
  for (std::size_t layer = shape.layers.size(); layer-- > 0;) {
    const std::size_t units = shape.layers[layer].units;
    const std::size_t fan_in = shape.fan_in(layer);
    first -= units;
    const Real* below = layer == 0 ? inputs : outputs + first - fan_in;
    Real* below_deltas = layer == 0 ? nullptr : deltas + first - fan_in;
    if (below_deltas != nullptr) std::fill_n(below_deltas, fan_in, Real{0});
    for (std::size_t unit = 0; unit < units; ++unit) {
      const Real delta =
          deltas[first + unit] * slope_from_output(shape.layers[layer].activation, outputs[first + unit]);
      const Real* weights = &parameters[shape.weights(layer) + unit * fan_in];
      Real* weight_gradient = gradient + shape.weights(layer) + unit * fan_in;
      for (std::size_t k = 0; k < fan_in; ++k) {
        weight_gradient[k] += delta * below[k];
        if (below_deltas != nullptr) below_deltas[k] += delta * weights[k];
      }
      gradient[shape.thresholds(layer) + unit] += delta;
    }
  }
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
  count_ = indices.size();
  inputs_.clear();
  targets_.clear();
  weights_.clear();
  for (const std::size_t p : indices) {
    const auto input = samples.inputs.subspan(p * shape.inputs, shape.inputs);
    const auto target = samples.targets.subspan(p * shape.outputs(), shape.outputs());
    inputs_.insert(inputs_.end(), input.begin(), input.end());
    targets_.insert(targets_.end(), target.begin(), target.end());
    weights_.push_back(samples.weights.empty() ? Real{1} : samples.weights[p]);
  }
}

template <std::floating_point Real>
FeedForward<Real>::FeedForward(NetworkShape shape) : shape_(std::move(shape)) {
  assert(shape_.validate());
  work_.resize(2 * unit_count(shape_) + shape_.parameter_count());
}

template <std::floating_point Real>
void FeedForward<Real>::evaluate(std::span<const Real> parameters, std::span<const Real> inputs,
                                 std::span<Real> outputs) {
  const std::size_t count = inputs.size() / shape_.inputs;
  assert(parameters.size() == shape_.parameter_count() && outputs.size() == count * shape_.outputs());
  for (std::size_t p = 0; p < count; ++p) {
    forward(shape_, parameters, &inputs[p * shape_.inputs], work_.data());
    std::copy_n(work_.data() + unit_count(shape_) - shape_.outputs(), shape_.outputs(), &outputs[p * shape_.outputs()]);
  }
}

template <std::floating_point Real>
double FeedForward<Real>::error(std::span<const Real> parameters, const PackedSamples<Real>& samples) {
  const Real* outputs = work_.data() + unit_count(shape_) - shape_.outputs();
  double sum = 0.0;
  for (std::size_t p = 0; p < samples.count(); ++p) {
    forward(shape_, parameters, &samples.inputs()[p * shape_.inputs], work_.data());
    for (std::size_t k = 0; k < shape_.outputs(); ++k) {
      const double difference = double{samples.targets()[p * shape_.outputs() + k]} - double{outputs[k]};
      sum += double{samples.weights()[p]} * difference * difference;
    }
  }
  return 0.5 * sum;
}

template <std::floating_point Real>
double FeedForward<Real>::error_and_gradient(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                                             std::span<Real> gradient) {
  const std::size_t units = unit_count(shape_);
  Real* deltas = work_.data() + units;
  std::fill(gradient.begin(), gradient.end(), Real{0});
  double sum = 0.0;
  for (std::size_t p = 0; p < samples.count(); ++p) {
    forward(shape_, parameters, &samples.inputs()[p * shape_.inputs], work_.data());
    for (std::size_t k = 0; k < shape_.outputs(); ++k) {
      const std::size_t unit = units - shape_.outputs() + k;
      const Real difference = work_[unit] - samples.targets()[p * shape_.outputs() + k];
      deltas[unit] = samples.weights()[p] * difference;
      sum += double{deltas[unit]} * double{difference};
    }
    backward(shape_, parameters, &samples.inputs()[p * shape_.inputs], work_.data(), deltas, gradient.data());
  }
  return 0.5 * sum;
}

template <std::floating_point Real>
double FeedForward<Real>::normal_equations(std::span<const Real> parameters, const PackedSamples<Real>& samples,
                                           std::span<Real> gradient, std::span<Real> normal) {
  const std::size_t n = shape_.parameter_count();
  const std::size_t units = unit_count(shape_);
  const std::span<Real> row = std::span(work_).subspan(2 * units, n);
  std::fill(normal.begin(), normal.end(), Real{0});
  for (std::size_t p = 0; p < samples.count(); ++p) {
    forward(shape_, parameters, &samples.inputs()[p * shape_.inputs], work_.data());
    for (std::size_t k = 0; k < shape_.outputs(); ++k) {
      Real* deltas = work_.data() + units;
      std::fill_n(deltas, units, Real{0});
      deltas[units - shape_.outputs() + k] = Real{1};
      std::fill(row.begin(), row.end(), Real{0});
      backward(shape_, parameters, &samples.inputs()[p * shape_.inputs], work_.data(), deltas, row.data());
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) normal[i * n + j] += samples.weights()[p] * row[i] * row[j];
      }
    }
  }
  return error_and_gradient(parameters, samples, gradient);
}

template class PackedSamples<float>;
template class PackedSamples<double>;
template class FeedForward<float>;
template class FeedForward<double>;

}  // namespace dermis::network
