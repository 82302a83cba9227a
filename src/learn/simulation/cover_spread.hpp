// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::simulation {

/// Spreads forces on the cover of an array (array.cover) over its taxels. Forces beyond the rim are lost.
class CoverSpread {
 public:
  /// The cover is known, or there is none.
  explicit CoverSpread(const ArrayDescription& array);

  /// The forces that the taxels feel [rows, cols].
  [[nodiscard]] std::vector<double> felt(const std::vector<double>& surface) const;

 private:
  std::size_t rows_;
  std::size_t cols_;
  std::vector<std::vector<double>> share_;  // [rows away][columns away]; empty: no cover
};

}  // namespace dermis::learn::simulation
