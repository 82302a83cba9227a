// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <functional>
#include <numeric>

#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

std::size_t Column::elements() const noexcept {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

std::string Column::name() const {
  if (array.empty() || quantity.empty()) return array + quantity;
  return array + "_" + quantity;
}

}  // namespace dermis::out::datasets
