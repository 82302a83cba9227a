// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/network_shape.hpp"

namespace dermis::paper {
namespace {

constexpr std::size_t kMaxUnits = 65'536;

bool is_size(std::size_t units) {
  return units >= 1 && units <= kMaxUnits;
}

}  // namespace

std::size_t NetworkShape::weights(std::size_t layer) const noexcept {
  std::size_t offset = 0;
  for (std::size_t below = 0; below < layer; ++below) offset += layers[below].units * (fan_in(below) + 1);
  return offset;
}

std::string NetworkShape::describe() const {
  std::string text = std::to_string(inputs);
  for (const Layer& layer : layers) text += "-" + std::to_string(layer.units);
  return text;
}

Status NetworkShape::validate() const {
  if (!is_size(inputs)) return bad_input("network.inputs: must be 1 to 65536");
  if (layers.empty() || layers.size() > kMaxLayers) return bad_input("network.layers: must be 1 to 64 layers");
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    if (!is_size(layers[layer].units)) {
      return bad_input("network.layers[" + std::to_string(layer) + "].units: must be 1 to 65536");
    }
    if (layers[layer].activation > Activation::linear) {
      return bad_input("network.layers[" + std::to_string(layer) + "].activation: unknown");
    }
  }
  return Done{};
}

}  // namespace dermis::paper
