// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/period.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostCompared = 4096;
constexpr std::size_t kLongest = 4096;
constexpr double kClear = 0.6;    // of the usual difference at most
constexpr double kAsGood = 1.15;  // times the least

/// Mean difference of numbers that lie so many apart; of great ones no more than of any others.
double difference_at(std::span<const float> numbers, std::size_t lag) {
  const std::size_t count = std::min(numbers.size() - lag, kMostCompared);
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = std::abs(static_cast<double>(numbers[i + lag]) - static_cast<double>(numbers[i]));
    sum += std::isfinite(difference) ? std::sqrt(difference) : 0.0;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

std::size_t period_of(std::span<const float> numbers, std::size_t least) {
  constexpr std::size_t kFewestFrames = 3;
  std::vector<double> differences;
  for (std::size_t lag = least; lag <= kLongest && kFewestFrames * lag <= numbers.size(); ++lag)
    differences.push_back(difference_at(numbers, lag));
  if (differences.size() < least) return 0;
  std::vector<double> sorted = differences;
  std::ranges::sort(sorted);
  if (!(sorted.front() < kClear * sorted[sorted.size() / 2])) return 0;
  const auto first = std::ranges::find_if(differences, [&](double one) { return one <= kAsGood * sorted.front(); });
  return least + static_cast<std::size_t>(first - differences.begin());
}

}  // namespace dermis::bytes::proposals
