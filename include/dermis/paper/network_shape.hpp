// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/network/activation.hpp"

namespace dermis::paper {

using touch::network::Activation;

inline constexpr std::size_t kMaxLayers = 64;

/// Neurons side by side, each connected to all outputs of the layer below.
struct Layer {
  std::size_t units = 1;  ///< 1 ... 65,536
  Activation activation = Activation::log_sigmoid;

  bool operator==(const Layer&) const = default;
};

/// A multi-layer feed-forward network (Fig. 8 of the paper; eq. (4) gives the output of each neuron).
///
/// Parameters are one flat vector, layer by layer from the inputs up: the weights [units, fan_in], row-major, then the
/// thresholds [units].
struct NetworkShape {
  std::size_t inputs = 1;     ///< 1 ... 65,536
  std::vector<Layer> layers;  ///< From the first above the inputs to the output layer; 1 ... kMaxLayers.

  [[nodiscard]] std::size_t outputs() const noexcept { return layers.back().units; }
  /// Inputs of each neuron of a layer, the threshold not counted.
  [[nodiscard]] std::size_t fan_in(std::size_t layer) const noexcept {
    return layer == 0 ? inputs : layers[layer - 1].units;
  }
  /// Where the weights of a layer start in the parameters; weights(layers.size()) is parameter_count().
  [[nodiscard]] std::size_t weights(std::size_t layer) const noexcept;
  /// Where the thresholds of a layer start.
  [[nodiscard]] std::size_t thresholds(std::size_t layer) const noexcept {
    return weights(layer) + layers[layer].units * fan_in(layer);
  }
  [[nodiscard]] std::size_t parameter_count() const noexcept { return weights(layers.size()); }

  /// "2-5-1": the inputs, then the units of each layer.
  [[nodiscard]] std::string describe() const;

  /// Names the first field that is out of its range.
  [[nodiscard]] Status validate() const;

  bool operator==(const NetworkShape&) const = default;
};

}  // namespace dermis::paper
