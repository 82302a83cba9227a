// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_PANEL_BACKWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_PANEL_BACKWARD_INL_HPP
#undef DERMIS_PAPER_PANEL_BACKWARD_INL_HPP
#else
#define DERMIS_PAPER_PANEL_BACKWARD_INL_HPP
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "hwy/highway.h"
#include "paper/bank/panel_tiles-inl.hpp"
#include "paper/bank/pattern_space.hpp"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using touch::network::HWY_NAMESPACE::slope_from_output;

/// Calls write(tag, values, column, row) for four values of a column at a time, those of rows row ... row + 3. Stored
/// as a row they make the transpose. `rows` and `columns` are rounded up to blocks of four.
template <class Write>
HWY_INLINE void transpose(Level from, std::size_t rows, std::size_t columns, const Write& write) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      write(FullTag(), hn::Load(FullTag(), from.values + row * from.stride + column), column, row);
    }
  }
#else
  const hn::FixedTag<float, 4> d;
  for (std::size_t row = 0; row < rows; row += 4) {
    for (std::size_t column = 0; column < columns; column += 4) {
      const float* block = from.values + row * from.stride + column;
      const auto row0 = hn::Load(d, block);
      const auto row1 = hn::Load(d, block + from.stride);
      const auto row2 = hn::Load(d, block + 2 * from.stride);
      const auto row3 = hn::Load(d, block + 3 * from.stride);
      const auto even_low = hn::InterleaveLower(d, row0, row2);
      const auto even_high = hn::InterleaveUpper(d, row0, row2);
      const auto odd_low = hn::InterleaveLower(d, row1, row3);
      const auto odd_high = hn::InterleaveUpper(d, row1, row3);
      write(d, hn::InterleaveLower(d, even_low, odd_low), column, row);
      write(d, hn::InterleaveUpper(d, even_low, odd_low), column + 1, row);
      write(d, hn::InterleaveLower(d, even_high, odd_high), column + 2, row);
      write(d, hn::InterleaveUpper(d, even_high, odd_high), column + 3, row);
    }
  }
#endif
}

/// columns_below[k][p] = sum over the units j of w_jk delta_pj.
inline void propagate(const PanelLayer& layer, const float* parameters, PatternSpace& space) {
  const FullTag d;
  const std::size_t stride = space.column_stride();
  const auto tile = [&](auto rows, auto vectors, std::size_t k, std::size_t pattern) {
    FullVector sums[rows()][vectors()];
    clear(sums);
    for (std::size_t unit = 0; unit < layer.units; unit += kPanelUnits) {
      const std::size_t width = layer.width(unit);
      accumulate(parameters + layer.panel(unit) + k * width, width, 1, space.columns() + unit * stride + pattern,
                 stride, std::min(width, layer.units - unit), sums);
    }
    for (std::size_t r = 0; r < rows(); ++r) {
      for (std::size_t v = 0; v < vectors(); ++v) {
        hn::Store(sums[r][v], d, space.columns_below() + (k + r) * stride + pattern + v * kVectorLanes);
      }
    }
  };
  std::size_t pattern = 0;
  for (; pattern + kTileVectors * kVectorLanes <= space.rows(); pattern += kTileVectors * kVectorLanes) {
    for_each_tile<kTileRows>(0, layer.fan_in, [&](auto rows, std::size_t k) {
      tile(rows, std::integral_constant<std::size_t, kTileVectors>(), k, pattern);
    });
  }
  for (; pattern < space.rows(); pattern += kVectorLanes) {
    for_each_tile<kTileRows>(0, layer.fan_in, [&](auto rows, std::size_t k) {
      tile(rows, std::integral_constant<std::size_t, 1>(), k, pattern);
    });
  }
}

/// The gradient of every weight, sum over the patterns of x_pk delta_pj, tile by tile, each applied at once.
template <class Rule>
void move_panels(const PanelLayer& layer, const Rule& rule, Level below, Level delta, std::size_t patterns) {
  for_each_columns(layer, [&](auto vectors, auto width, std::size_t unit, std::size_t place) {
    for_each_tile<kTileRows>(0, layer.steps(), [&](auto rows, std::size_t step) {
      const auto place_of = [&](std::size_t r, std::size_t v) {
        return place + (step + r) * width() + v * kVectorLanes;
      };
      for (std::size_t r = 0; r < rows(); ++r) {
        for (std::size_t v = 0; v < vectors(); ++v) rule.prefetch(place_of(r, v));
      }
      FullVector sums[rows()][vectors()];
      clear(sums);
      accumulate(below.values + step, 1, below.stride, delta.values + unit, delta.stride, patterns, sums);
      for (std::size_t r = 0; r < rows(); ++r) {
        for (std::size_t v = 0; v < vectors(); ++v) {
          rule.move(place_of(r, v), sums[r][v]);
        }
      }
    });
  });
}

/// A layer of one unit. Moves its weights and, unless it is the lowest, turns the outputs of the layer below into its
/// deltas, both in one pass.
template <class Rule>
void move_row(const PanelLayer& layer, const float* weights, const Rule& rule, const PanelLayer* layer_below,
              Level below, Level delta, std::size_t rows) {
  const FullTag d;
  for (std::size_t k = 0; k < layer.size(); k += kVectorLanes) {
    const auto weight = hn::Load(d, weights + k);
    auto gradient = hn::Zero(d);
    for (std::size_t row = 0; row < rows; ++row) {
      float* place = below.values + row * below.stride + k;
      const auto output = hn::Load(d, place);
      const auto own = hn::Set(d, delta.values[row * delta.stride]);
      gradient = hn::MulAdd(own, output, gradient);
      if (layer_below == nullptr) continue;
      hn::Store(hn::Mul(hn::Mul(own, weight), slope_from_output(d, layer_below->activation, output)), d, place);
    }
    rule.move(layer.first + k, gradient);
  }
}

template <class Rule>
void backward(const PanelLayout& layout, const float* parameters, const Rule& rule, PatternSpace& space,
              std::size_t patterns) {
  for (std::size_t l = layout.layers().size(); l-- > 0;) {
    const PanelLayer& layer = layout.layers()[l];
    const PanelLayer* layer_below = l == 0 ? nullptr : &layout.layers()[l - 1];
    const Level below{space.level(l), space.stride(l)};
    const Level delta{space.level(l + 1), space.stride(l + 1)};
    if (layer.is_row()) {
      move_row(layer, parameters + layer.first, rule, layer_below, below, delta, space.rows());
    } else {
      if (layer_below != nullptr) {
        transpose(delta, space.rows(), layer.units, [&](auto d, auto values, std::size_t unit, std::size_t pattern) {
          hn::Store(values, d, space.columns() + unit * space.column_stride() + pattern);
        });
        propagate(layer, parameters, space);
      }
      move_panels(layer, rule, below, delta, patterns);
      if (layer_below != nullptr) {
        transpose({space.columns_below(), space.column_stride()}, layer.fan_in, space.rows(),
                  [&](auto d, auto values, std::size_t pattern, std::size_t unit) {
                    float* place = below.values + pattern * below.stride + unit;
                    const auto slope = slope_from_output(d, layer_below->activation, hn::Load(d, place));
                    hn::Store(hn::Mul(values, slope), d, place);
                  });
      }
    }
    for (std::size_t row = 0; layer_below != nullptr && row < space.rows(); ++row) {
      std::fill(below.values + row * below.stride + layer.fan_in, below.values + (row + 1) * below.stride, 0.0F);
    }
  }
}

/// The error of the batch from what the network puts out, which becomes the deltas of its last layer.
inline float take_error(const PanelLayer& layer, Level outputs, PatternSpace& space, std::size_t patterns) {
  double error = 0.0;
  for (std::size_t p = 0; p < space.rows(); ++p) {
    float* row = outputs.values + p * outputs.stride;
    const std::size_t units = p < patterns ? layer.units : 0;
    for (std::size_t k = 0; k < units; ++k) {
      const float difference = row[k] - space.targets[p * units + k];
      const float scaled = space.weights[p] * difference;
      error += 0.5 * double{scaled} * double{difference};
      row[k] = scaled * touch::network::slope_from_output(layer.activation, row[k]);
    }
    std::fill(row + units, row + outputs.stride, 0.0F);
  }
  return static_cast<float>(error);
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
