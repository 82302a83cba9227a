// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/pattern_space.hpp"

#include <utility>

namespace dermis::paper {

std::size_t row_stride(std::size_t values) {
  return (round_up(values + 1, kLanes) / kLanes | 1U) * kLanes;
}

PatternSpace::PatternSpace(const PanelLayout& layout, std::size_t patterns)
    : targets(patterns * layout.outputs()),
      weights(patterns),
      rows_(round_up(patterns, kLanes)),
      column_stride_(row_stride(rows_)) {
  std::size_t size = 0;
  const auto reserve = [&](std::size_t values) { return std::exchange(size, size + values); };
  const auto add_level = [&](std::size_t values) {
    strides_.push_back(row_stride(values));
    starts_.push_back(reserve(rows_ * strides_.back()));
  };
  add_level(layout.inputs());
  for (const PanelLayer& layer : layout.layers()) add_level(layer.units);
  columns_ = reserve(layout.widest() * column_stride_);
  columns_below_ = reserve(layout.widest() * column_stride_);
  values_.resize(size);
}

}  // namespace dermis::paper
