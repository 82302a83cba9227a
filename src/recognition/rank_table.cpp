// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/rank_table.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::recognition {

std::vector<float> rank_table(std::vector<double> values) {
  constexpr std::size_t kMostValues = 256;
  std::sort(values.begin(), values.end());
  const std::size_t count = std::min(values.size(), kMostValues);
  std::vector<float> table;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = count > 1 ? i * (values.size() - 1) / (count - 1) : 0;
    table.push_back(static_cast<float>(values[place]));
  }
  return table;
}

double rank_in(std::span<const float> table, double value) {
  const auto above = std::upper_bound(table.begin(), table.end(), value,
                                      [](double wanted, float entry) { return wanted < static_cast<double>(entry); });
  const auto count = static_cast<double>(table.size());
  const auto largest = static_cast<double>(table.back());
  if (above == table.end() && largest > 0.0) return 1.0 + std::log(value / largest);
  if (above == table.end() || above == table.begin()) return above == table.end() ? 1.0 : 0.0;
  const auto below_value = static_cast<double>(*(above - 1));
  const double between = (value - below_value) / (static_cast<double>(*above) - below_value);
  return (static_cast<double>(above - table.begin()) - 1.0 + between) / count;
}

}  // namespace dermis::recognition
