// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "paper/bank/huge_vector.hpp"
#include "paper/bank/panel_layout.hpp"

namespace dermis::paper {

/// Patterns that evaluating takes through the layers together: what they put out and a layer's weights stay in the
/// cache.
inline constexpr std::size_t kBlock = 64;

/// Values from the start of a row of a work space to the next. Rows start at odd multiples of a cache line: at powers
/// of two they would displace each other.
[[nodiscard]] std::size_t row_stride(std::size_t values);

/// Work space of one thread for a batch of patterns: what each layer puts out, [patterns, stride], pattern by pattern.
class PatternSpace {
 public:
  PatternSpace(const PanelLayout& layout, std::size_t patterns);

  /// Rows that a batch of this size occupies: whole lanes.
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Level 0 holds the inputs, level l + 1 what layer l puts out and, on the way back, its deltas.
  [[nodiscard]] float* level(std::size_t level) { return values_.data() + starts_[level]; }
  [[nodiscard]] std::size_t stride(std::size_t level) const { return strides_[level]; }
  /// Deltas of a layer with the patterns side by side, [units, column_stride].
  [[nodiscard]] float* columns() { return values_.data() + columns_; }
  /// Values for the layer below, of the same form.
  [[nodiscard]] float* columns_below() { return values_.data() + columns_below_; }
  [[nodiscard]] std::size_t column_stride() const { return column_stride_; }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(float); }

  std::vector<float> targets;  ///< [patterns, outputs]
  std::vector<float> weights;  ///< [patterns], over the number of patterns.

 private:
  std::size_t rows_;
  std::size_t column_stride_;
  std::size_t columns_ = 0;
  std::size_t columns_below_ = 0;
  std::vector<std::size_t> strides_;
  std::vector<std::size_t> starts_;
  HugeVector<float> values_;
};

/// The parameters of one network and, for Adam, the moments of their gradients.
struct PanelParameters {
  float* values;
  float* first_moments;
  float* second_moments;
};

}  // namespace dermis::paper
