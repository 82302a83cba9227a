// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "dermis/paper/network_shape.hpp"

namespace dermis::paper {

/// A layer and the places of its parameters and units.
struct PlacedLayer {
  std::size_t units = 0;
  std::size_t fan_in = 0;
  std::size_t weights = 0;     ///< Where they start in the parameters.
  std::size_t thresholds = 0;  ///< Where they start in the parameters.
  std::size_t first_unit = 0;  ///< Units of all layers below.
  Activation activation = Activation::linear;
};

/// A shape with its offsets, which kernels ask for all the time. Lives on the stack.
struct PlacedShape {
  explicit PlacedShape(const NetworkShape& shape) : inputs(shape.inputs), layer_count(shape.layers.size()) {
    std::size_t fan_in = inputs;
    for (std::size_t l = 0; l < layer_count; ++l) {
      const Layer& layer = shape.layers[l];
      const std::size_t thresholds = parameters + layer.units * fan_in;
      layers[l] = {layer.units, fan_in, parameters, thresholds, units, layer.activation};
      parameters = thresholds + layer.units;
      units += layer.units;
      widest = std::max(widest, layer.units);
      fan_in = layer.units;
    }
  }

  [[nodiscard]] const PlacedLayer& top() const { return layers[layer_count - 1]; }
  [[nodiscard]] std::size_t outputs() const { return top().units; }

  std::size_t inputs;
  std::size_t layer_count;
  std::size_t parameters = 0;
  std::size_t units = 0;   ///< Of all layers.
  std::size_t widest = 0;  ///< Units of the widest layer.
  std::array<PlacedLayer, kMaxLayers> layers;
};

}  // namespace dermis::paper
