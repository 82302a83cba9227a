// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>

namespace dermis::learn::recognition {

/// How far the score of a kernel regression is below 1, which it is at the examples of a class.
[[nodiscard]] inline double kernel_distance(double score) noexcept {
  return std::max(1.0 - score, 0.0);
}

}  // namespace dermis::learn::recognition
