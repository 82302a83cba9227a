// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/paper/network_shape.hpp"

namespace dermis::paper {

/// Granule of panel widths and of the rows of a work space; as many floats as the widest vector holds.
inline constexpr std::size_t kLanes = 16;
inline constexpr std::size_t kPanelUnits = 32;

[[nodiscard]] constexpr std::size_t round_up(std::size_t count, std::size_t granule) {
  return (count + granule - 1) / granule * granule;
}

/// A pattern as the layers read it: its inputs, the 1 that the thresholds weigh, and zeros.
inline void pack_row(std::span<const float> inputs, std::span<float> row) {
  auto end = std::copy(inputs.begin(), inputs.end(), row.begin());
  *end++ = 1.0F;
  std::fill(end, row.end(), 0.0F);
}

/// A layer of PanelLayout. The threshold of a unit is the weight of one more input that is always 1: `steps` inputs.
struct PanelLayer {
  std::size_t fan_in;
  std::size_t units;
  Activation activation;
  std::size_t first;  ///< Where the layer starts.

  [[nodiscard]] std::size_t steps() const { return fan_in + 1; }
  /// A layer of one unit is a row of weights, padded to whole lanes; all others are panels.
  [[nodiscard]] bool is_row() const { return units == 1; }
  [[nodiscard]] std::size_t padded_units() const { return is_row() ? 1 : round_up(units, kLanes); }
  [[nodiscard]] std::size_t size() const { return is_row() ? round_up(steps(), kLanes) : steps() * padded_units(); }
  /// Units of the panel that starts with a unit: 32, or 16 in the last panel.
  [[nodiscard]] std::size_t width(std::size_t unit) const { return std::min(kPanelUnits, padded_units() - unit); }
  [[nodiscard]] std::size_t panel(std::size_t unit) const { return first + unit * steps(); }
  [[nodiscard]] std::size_t place(std::size_t unit, std::size_t step) const {
    if (is_row()) return first + step;
    const std::size_t panel_unit = unit / kPanelUnits * kPanelUnits;
    return panel(panel_unit) + step * width(panel_unit) + unit - panel_unit;
  }
};

/// How the parameters of one network lie in memory: in the order in which evaluating reads them. A layer is cut in
/// panels of 32 units. A panel is a matrix [fan_in + 1, 32]. One pass over it, from end to end, serves the product with
/// one pattern and with many. Padding is 0.
class PanelLayout {
 public:
  explicit PanelLayout(const NetworkShape& shape);

  [[nodiscard]] const std::vector<PanelLayer>& layers() const { return layers_; }
  [[nodiscard]] std::size_t inputs() const { return layers_.front().fan_in; }
  [[nodiscard]] std::size_t outputs() const { return layers_.back().units; }
  /// Values a network, a multiple of 16.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The most values that a layer or the inputs need in a work space: all units, a 1 and padding.
  [[nodiscard]] std::size_t widest() const;

  /// Calls visit(index in the parameters as NetworkShape orders them, place in the layout) for every parameter.
  template <class Visit>
  void for_each_parameter(Visit visit) const {
    std::size_t index = 0;
    for (const PanelLayer& layer : layers_) {
      for (std::size_t unit = 0; unit < layer.units; ++unit) {
        for (std::size_t k = 0; k < layer.fan_in; ++k) visit(index++, layer.place(unit, k));
      }
      for (std::size_t unit = 0; unit < layer.units; ++unit) visit(index++, layer.place(unit, layer.fan_in));
    }
  }

 private:
  std::vector<PanelLayer> layers_;
  std::size_t size_ = 0;
};

}  // namespace dermis::paper
