// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/panel_layout.hpp"

namespace dermis::paper {

PanelLayout::PanelLayout(const NetworkShape& shape) {
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    const Layer& own = shape.layers[layer];
    layers_.push_back({shape.fan_in(layer), own.units, own.activation, size_});
    size_ += layers_.back().size();
  }
}

std::size_t PanelLayout::widest() const {
  std::size_t widest = inputs();
  for (const PanelLayer& layer : layers_) widest = std::max(widest, layer.units);
  return round_up(widest + 1, kLanes);
}

}  // namespace dermis::paper
