// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "paper/bank/huge_vector.hpp"
#include "paper/bank/panel_layout.hpp"

namespace dermis::paper {

/// Work space of one frame through networks in panels. Allocates only at the first frame.
class FrameSpace {
 public:
  void prepare(const PanelLayout& layout, std::span<const float> inputs, std::size_t workers) {
    inputs_.resize(round_up(inputs.size() + 1, kLanes));
    pack_row(inputs, inputs_);
    rows_each_ = 2 * layout.widest();
    rows_.resize(std::max(rows_.size(), workers * rows_each_));
    backwards_ = !backwards_;
  }

  /// The network to take as number `item` of the frame. Every other frame goes backwards, and so begins with the
  /// parameters that the frame before has left in the cache.
  [[nodiscard]] std::size_t network(std::size_t item, std::size_t networks) const {
    return backwards_ ? networks - 1 - item : item;
  }

  [[nodiscard]] const float* inputs() const { return inputs_.data(); }
  /// Two rows of layout.widest() for the outputs of layers.
  [[nodiscard]] float* rows(std::size_t worker) { return rows_.data() + worker * rows_each_; }

 private:
  bool backwards_ = false;
  std::size_t rows_each_ = 0;
  HugeVector<float> inputs_;
  HugeVector<float> rows_;
};

}  // namespace dermis::paper
