// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dermis::learn::arrangement {

/// The upper of two in the middle. Takes at least one value, and changes their order.
template <typename Value>
[[nodiscard]] Value median_of(std::vector<Value>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dermis::learn::arrangement
