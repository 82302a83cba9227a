// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

namespace dermis::learn::recognition {

/// At most 256 of the values (at least one), rising, that stand for all of them.
[[nodiscard]] std::vector<float> rank_table(std::vector<double> values);

/// The share of a table's values that a value exceeds, 0 ... 1; beyond the largest it grows on with the logarithm.
[[nodiscard]] double rank_in(std::span<const float> table, double value);

/// The rank of each value in the table of all others, as a later value will have it. Alone it has 1.
[[nodiscard]] std::vector<double> ranks_among_others(const std::vector<double>& values);

}  // namespace dermis::learn::recognition
