// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/initialisation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "dermis/touch/frames/random.hpp"

namespace dermis::paper {
namespace {

/// Sums at which a neuron is active, and its outputs.
struct Region {
  double half_width;
  InputRange outputs;
};

std::optional<Region> active_region(Activation activation) {
  switch (activation) {
    case Activation::log_sigmoid: return Region{4.0, {0.0, 1.0}};
    case Activation::tanh: return Region{2.0, {-1.0, 1.0}};
    default: return std::nullopt;
  }
}

/// The weights and thresholds of one layer.
struct LayerView {
  std::size_t units;
  std::size_t fan_in;
  double* weights;
  double* thresholds;
};

void draw_xavier(const LayerView& layer, Random& random) {
  const double range = std::sqrt(6.0 / static_cast<double>(layer.fan_in + layer.units));
  std::generate_n(layer.weights, layer.units * layer.fan_in, [&] { return random.uniform(-range, range); });
}

/// -1 ... 1 in even distances; 0 for a single one.
double spread(std::size_t unit, std::size_t units) {
  return units == 1 ? 0.0 : 2.0 * static_cast<double>(unit) / static_cast<double>(units - 1) - 1.0;
}

void draw_nguyen_widrow(const LayerView& layer, double half_width, std::span<const InputRange> ranges, Random& random) {
  const double length = 0.7 * std::pow(static_cast<double>(layer.units), 1.0 / static_cast<double>(layer.fan_in));
  for (std::size_t unit = 0; unit < layer.units; ++unit) {
    double* weights = layer.weights + unit * layer.fan_in;
    double square = 0.0;
    for (std::size_t k = 0; k < layer.fan_in; ++k) {
      weights[k] = random.uniform(-1.0, 1.0);
      square += weights[k] * weights[k];
    }
    const double stretch = half_width * length / std::sqrt(square);
    double& threshold = layer.thresholds[unit];
    threshold = half_width * length * spread(unit, layer.units) * std::copysign(1.0, weights[0]);
    for (std::size_t k = 0; k < layer.fan_in; ++k) {
      const auto [least, greatest] = ranges[k];
      weights[k] = greatest > least ? 2.0 * stretch * weights[k] / (greatest - least) : 0.0;
      threshold -= weights[k] * 0.5 * (least + greatest);
    }
  }
}

template <std::floating_point Real>
std::vector<Real> rounded(const std::vector<double>& parameters) {
  std::vector<Real> result(parameters.size());
  std::transform(parameters.begin(), parameters.end(), result.begin(),
                 [](double value) { return static_cast<Real>(value); });
  return result;
}

/// draw(layer number, view) fills each layer; all begin as 0.
template <std::floating_point Real, typename Draw>
std::vector<Real> draw_layers(const NetworkShape& shape, const Draw& draw) {
  std::vector<double> parameters(shape.parameter_count());
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    draw(layer, LayerView{shape.layers[layer].units, shape.fan_in(layer), &parameters[shape.weights(layer)],
                          &parameters[shape.thresholds(layer)]});
  }
  return rounded<Real>(parameters);
}

}  // namespace

template <std::floating_point Real>
std::vector<Real> uniform_start(const NetworkShape& shape, double range, std::uint64_t seed) {
  assert(range >= 0.0 && std::isfinite(range));
  Random random(seed);
  std::vector<double> parameters(shape.parameter_count());
  for (double& value : parameters) value = random.uniform(-range, range);
  return rounded<Real>(parameters);
}

template <std::floating_point Real>
std::vector<Real> xavier_start(const NetworkShape& shape, std::uint64_t seed) {
  Random random(seed);
  return draw_layers<Real>(shape, [&](std::size_t, const LayerView& layer) { draw_xavier(layer, random); });
}

template <std::floating_point Real>
std::vector<InputRange> input_ranges(const Samples<Real>& samples, std::size_t inputs) {
  assert(samples.count > 0 && samples.inputs.size() == samples.count * inputs);
  std::vector<InputRange> ranges(inputs);
  for (std::size_t k = 0; k < inputs; ++k) ranges[k] = {double{samples.inputs[k]}, double{samples.inputs[k]}};
  for (std::size_t p = 1; p < samples.count; ++p) {
    for (std::size_t k = 0; k < inputs; ++k) {
      const auto value = double{samples.inputs[p * inputs + k]};
      ranges[k] = {std::min(ranges[k].least, value), std::max(ranges[k].greatest, value)};
    }
  }
  return ranges;
}

template <std::floating_point Real>
std::vector<Real> nguyen_widrow_start(const NetworkShape& shape, std::span<const InputRange> ranges,
                                      std::uint64_t seed) {
  assert(ranges.size() == shape.inputs);
  Random random(seed);
  std::vector<InputRange> below(ranges.begin(), ranges.end());  // empty: without an end
  return draw_layers<Real>(shape, [&](std::size_t number, const LayerView& layer) {
    const std::optional<Region> region = active_region(shape.layers[number].activation);
    if (region && !below.empty()) {
      draw_nguyen_widrow(layer, region->half_width, below, random);
    } else {
      draw_xavier(layer, random);
    }
    below.assign(region ? layer.units : 0, region ? region->outputs : InputRange{});
  });
}

template std::vector<float> uniform_start(const NetworkShape&, double, std::uint64_t);
template std::vector<double> uniform_start(const NetworkShape&, double, std::uint64_t);
template std::vector<float> xavier_start(const NetworkShape&, std::uint64_t);
template std::vector<double> xavier_start(const NetworkShape&, std::uint64_t);
template std::vector<InputRange> input_ranges(const Samples<float>&, std::size_t);
template std::vector<InputRange> input_ranges(const Samples<double>&, std::size_t);
template std::vector<float> nguyen_widrow_start(const NetworkShape&, std::span<const InputRange>, std::uint64_t);
template std::vector<double> nguyen_widrow_start(const NetworkShape&, std::span<const InputRange>, std::uint64_t);

}  // namespace dermis::paper
