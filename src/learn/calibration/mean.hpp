// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <numeric>
#include <vector>

namespace dermis::learn::calibration {

/// Arithmetic mean of `values`, of which there is at least one.
[[nodiscard]] inline double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace dermis::learn::calibration
