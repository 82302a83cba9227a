// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/answer/rank_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dermis::learn::recognition {

namespace {

/// `value_at(place)`: of so many that rise.
template <typename ValueAt>
std::vector<float> table_of(std::size_t values, const ValueAt& value_at) {
  constexpr std::size_t kMostValues = 256;
  const std::size_t count = std::min(values, kMostValues);
  std::vector<float> table;
  table.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = count > 1 ? i * (values - 1) / (count - 1) : 0;
    table.push_back(static_cast<float>(value_at(place)));
  }
  return table;
}

}  // namespace

std::vector<float> rank_table(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return table_of(values.size(), [&](std::size_t place) { return values[place]; });
}

std::vector<double> ranks_among_others(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size(), 1.0);
  for (std::size_t own = 0; own < order.size() && order.size() > 1; ++own) {
    const auto other_at = [&](std::size_t place) { return values[order[place < own ? place : place + 1]]; };
    ranks[order[own]] = rank_in(table_of(order.size() - 1, other_at), values[order[own]]);
  }
  return ranks;
}

double rank_in(std::span<const float> table, double value) {
  const auto above = std::upper_bound(table.begin(), table.end(), value,
                                      [](double wanted, float entry) { return wanted < static_cast<double>(entry); });
  if (!(value > static_cast<double>(table.front()))) return 0.0;
  const auto count = static_cast<double>(table.size());
  const auto largest = static_cast<double>(table.back());
  if (above == table.end() && largest > 0.0) return 1.0 + std::log(value / largest);
  if (above == table.end()) return 1.0;
  const auto below_value = static_cast<double>(*(above - 1));
  const double between = (value - below_value) / (static_cast<double>(*above) - below_value);
  return (static_cast<double>(above - table.begin()) - 1.0 + between) / count;
}

}  // namespace dermis::learn::recognition
