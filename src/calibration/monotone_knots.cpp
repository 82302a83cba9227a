// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/monotone_knots.hpp"

#include <utility>

namespace dermis::calibration {

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
    Knot& previous = merged.back();
    const double weight = previous.weight + knot.weight;
    previous = {(previous.x * previous.weight + knot.x * knot.weight) / weight,
                (previous.y * previous.weight + knot.y * knot.weight) / weight, weight};
  }
  knots = std::move(merged);
}

void pool_adjacent_violators(std::vector<Knot>& knots) {
  std::vector<Knot> pooled;
  for (Knot knot : knots) {
    while (!pooled.empty() && pooled.back().y >= knot.y) {
      const Knot& previous = pooled.back();
      const double weight = previous.weight + knot.weight;
      knot = {(previous.x * previous.weight + knot.x * knot.weight) / weight,
              (previous.y * previous.weight + knot.y * knot.weight) / weight, weight};
      pooled.pop_back();
    }
    pooled.push_back(knot);
  }
  knots = std::move(pooled);
}

}  // namespace dermis::calibration
