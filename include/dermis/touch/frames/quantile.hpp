// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace dermis {

/// Place of the smallest of `count` rising values (at least 1) that at least `share` (0 ... 1) of them do not exceed.
[[nodiscard]] inline std::size_t nearest_rank(std::size_t count, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
  return std::max<std::size_t>(rank, 1) - 1;
}

/// The value at `place` of the sorted values, counted from 0; there must be more values than that.
template <typename Number>
[[nodiscard]] Number ranked(std::vector<Number> values, std::size_t place) {
  const auto here = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), here, values.end());
  return *here;
}

/// The smallest of the values (at least one) that at least `share` (0 ... 1) of them do not exceed.
template <typename Number>
[[nodiscard]] Number quantile(std::vector<Number> values, double share) {
  const std::size_t place = nearest_rank(values.size(), share);
  return ranked(std::move(values), place);
}

/// The middle one of the values (at least one). For an even number it is the upper of the two; quantile(values, 0.5) is
/// the lower.
template <typename Number>
[[nodiscard]] Number upper_median(std::vector<Number> values) {
  const std::size_t place = values.size() / 2;
  return ranked(std::move(values), place);
}

}  // namespace dermis
