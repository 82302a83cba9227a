// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_order.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace dermis::learn::calibration {
namespace {

// Presses of one weight in a row. In later rounds a longer run costs nothing: all taxels have had a weight.
constexpr std::size_t kFirstRun = 2;
constexpr std::size_t kLaterRun = 4;

double square_distance(std::size_t a, std::size_t b, std::size_t cols) {
  const auto between = [](std::size_t x, std::size_t y) { return static_cast<double>(x) - static_cast<double>(y); };
  const double rows_apart = between(a / cols, b / cols);
  const double cols_apart = between(a % cols, b % cols);
  return rows_apart * rows_apart + cols_apart * cols_apart;
}

/// From the taxel that is nearest to all others, each next one as far from the earlier ones as possible.
std::vector<std::size_t> farthest_first(std::vector<std::size_t> taxels, std::size_t cols) {
  const auto farthest_from = [&](std::size_t taxel) {
    double most = 0.0;
    for (const std::size_t other : taxels) most = std::max(most, square_distance(taxel, other, cols));
    return most;
  };
  std::vector<double> rank(taxels.size());  // of the first: how central; then the distance from those before
  std::transform(taxels.begin(), taxels.end(), rank.begin(), [&](std::size_t taxel) { return -farthest_from(taxel); });
  std::vector<double> nearest(taxels.size(), std::numeric_limits<double>::infinity());
  for (std::size_t done = 0; done < taxels.size(); ++done) {
    const auto& by = done == 0 ? rank : nearest;
    const auto begin = by.begin() + static_cast<std::ptrdiff_t>(done);
    const auto place = static_cast<std::size_t>(std::max_element(begin, by.end()) - by.begin());
    // Those behind keep their order, so that of equally good ones the first is taken.
    const auto from = static_cast<std::ptrdiff_t>(done);
    const auto to = static_cast<std::ptrdiff_t>(place);
    std::rotate(taxels.begin() + from, taxels.begin() + to, taxels.begin() + to + 1);
    std::rotate(nearest.begin() + from, nearest.begin() + to, nearest.begin() + to + 1);
    for (std::size_t k = done + 1; k < taxels.size(); ++k) {
      nearest[k] = std::min(nearest[k], square_distance(taxels[k], taxels[done], cols));
    }
  }
  return taxels;
}

/// The lightest, the heaviest, and so on inwards.
std::vector<double> from_the_ends(std::vector<double> weights_n) {
  std::sort(weights_n.begin(), weights_n.end());
  std::vector<double> order;
  for (std::size_t k = 0; k < weights_n.size(); ++k) {
    order.push_back(k % 2 == 0 ? weights_n[k / 2] : weights_n[weights_n.size() - 1 - k / 2]);
  }
  return order;
}

}  // namespace

std::vector<PlannedPress> spread_presses(const CalibrationPlan& plan, std::size_t cols) {
  const std::vector<std::size_t> taxels = farthest_first(plan.taxels, cols);
  const std::vector<double> weights_n = from_the_ends(plan.weights_n);
  std::vector<std::size_t> turn(weights_n.size());
  std::iota(turn.begin(), turn.end(), std::size_t{0});
  std::vector<PlannedPress> presses;
  for (std::size_t round = 0; round < turn.size(); ++round) {
    const std::size_t piece = (round == 0 ? kFirstRun : kLaterRun) * turn.size();
    for (std::size_t begin = 0; begin < taxels.size(); begin += piece) {
      for (const std::size_t weight : turn) {
        for (std::size_t k = begin; k < std::min(begin + piece, taxels.size()); ++k) {
          if ((k + round) % turn.size() == weight) presses.push_back({taxels[k], weights_n[weight]});
        }
      }
      std::reverse(turn.begin(), turn.end());  // the next piece begins with the weight that is at hand
    }
  }
  return presses;
}

}  // namespace dermis::learn::calibration
