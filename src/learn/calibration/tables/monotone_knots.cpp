// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/tables/monotone_knots.hpp"

#include <utility>

namespace dermis::learn::calibration {
namespace {

Knot pooled_knot(const Knot& a, const Knot& b) {
  const double weight = a.weight + b.weight;
  return {(a.x * a.weight + b.x * b.weight) / weight, (a.y * a.weight + b.y * b.weight) / weight, weight};
}

/// Pools a knot with those before it until rises(previous, knot).
template <typename Rises>
void pool_until(std::vector<Knot>& knots, Rises rises) {
  std::vector<Knot> pooled;
  for (Knot knot : knots) {
    while (!pooled.empty() && !rises(pooled.back(), knot)) {
      knot = pooled_knot(pooled.back(), knot);
      pooled.pop_back();
    }
    pooled.push_back(knot);
  }
  knots = std::move(pooled);
}

}  // namespace

void thin_out(std::vector<Knot>& knots, std::size_t most) {
  if (knots.size() <= most) return;
  std::vector<Knot> thinned(most, Knot{0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < knots.size(); ++k) {
    Knot& target = thinned[k * most / knots.size()];
    target.x += knots[k].x * knots[k].weight;
    target.y += knots[k].y * knots[k].weight;
    target.weight += knots[k].weight;
  }
  for (Knot& knot : thinned) {
    knot.x /= knot.weight;
    knot.y /= knot.weight;
  }
  knots = std::move(thinned);
}

void merge_equal(std::vector<Knot>& knots, double least_step) {
  std::vector<Knot> merged;
  for (const Knot& knot : knots) {
    if (merged.empty() || knot.x - merged.back().x >= least_step) {
      merged.push_back(knot);
      continue;
    }
    merged.back() = pooled_knot(merged.back(), knot);
  }
  knots = std::move(merged);
}

void pool_adjacent_violators(std::vector<Knot>& knots) {
  pool_until(knots, [](const Knot& a, const Knot& b) { return a.y < b.y; });
}

void pool_equal_floats(std::vector<Knot>& knots) {
  pool_until(knots, [](const Knot& a, const Knot& b) {
    return static_cast<float>(a.x) < static_cast<float>(b.x) && static_cast<float>(a.y) < static_cast<float>(b.y);
  });
}

}  // namespace dermis::learn::calibration
