// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "dermis/paper/network_shape.hpp"

namespace dermis::paper {

/// A BP network as the paper states it, one neuron and one pattern at a time in double precision: plain and slow, so
/// that it shares nothing with the engine that it judges.
class ReferenceNetwork {
 public:
  ReferenceNetwork(NetworkShape shape, std::vector<double> parameters)
      : shape_(std::move(shape)), parameters_(std::move(parameters)) {}

  /// Eq. (4), layer by layer; the inputs come first.
  [[nodiscard]] std::vector<std::vector<double>> layer_outputs(const std::vector<double>& inputs) const {
    std::vector<std::vector<double>> outputs = {inputs};
    for (std::size_t layer = 0; layer < shape_.layers.size(); ++layer) {
      std::vector<double> above;
      for (std::size_t unit = 0; unit < shape_.layers[layer].units; ++unit) {
        double sum = parameters_[threshold(layer, unit)];
        for (std::size_t k = 0; k < shape_.fan_in(layer); ++k) {
          sum += parameters_[weight(layer, unit, k)] * outputs.back()[k];
        }
        above.push_back(transfer(shape_.layers[layer].activation, sum));
      }
      outputs.push_back(above);
    }
    return outputs;
  }

  /// d output / d parameter, by the chain rule from the output down.
  [[nodiscard]] std::vector<double> output_gradient(const std::vector<std::vector<double>>& outputs,
                                                    std::size_t output) const {
    std::vector<double> gradient(parameters_.size(), 0.0);
    std::vector<double> from_above(shape_.outputs(), 0.0);  // d output / d output of the layer's neurons
    from_above[output] = 1.0;
    for (std::size_t layer = shape_.layers.size(); layer-- > 0;) {
      std::vector<double> to_below(shape_.fan_in(layer), 0.0);
      for (std::size_t unit = 0; unit < shape_.layers[layer].units; ++unit) {
        const double delta = from_above[unit] * slope(shape_.layers[layer].activation, outputs[layer + 1][unit]);
        gradient[threshold(layer, unit)] = delta;
        for (std::size_t k = 0; k < to_below.size(); ++k) {
          gradient[weight(layer, unit, k)] = delta * outputs[layer][k];
          to_below[k] += delta * parameters_[weight(layer, unit, k)];
        }
      }
      from_above = to_below;
    }
    return gradient;
  }

 private:
  [[nodiscard]] std::size_t weight(std::size_t layer, std::size_t unit, std::size_t k) const {
    std::size_t place = unit * shape_.fan_in(layer) + k;
    for (std::size_t below = 0; below < layer; ++below) {
      place += shape_.layers[below].units * (shape_.fan_in(below) + 1);
    }
    return place;
  }
  [[nodiscard]] std::size_t threshold(std::size_t layer, std::size_t unit) const {
    return weight(layer, shape_.layers[layer].units, 0) + unit;
  }
  static double transfer(Activation activation, double sum) {
    if (activation == Activation::log_sigmoid) return 1.0 / (1.0 + std::exp(-sum));
    if (activation == Activation::tanh) return std::tanh(sum);
    if (activation == Activation::relu) return std::fmax(sum, 0.0);
    return sum;
  }
  static double slope(Activation activation, double output) {
    if (activation == Activation::log_sigmoid) return output * (1.0 - output);
    if (activation == Activation::tanh) return 1.0 - output * output;
    if (activation == Activation::relu) return output > 0.0 ? 1.0 : 0.0;
    return 1.0;
  }

  NetworkShape shape_;
  std::vector<double> parameters_;
};

}  // namespace dermis::paper
