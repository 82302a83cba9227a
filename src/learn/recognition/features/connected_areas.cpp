// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/connected_areas.hpp"

#include <algorithm>
#include <utility>

#include "dermis/touch/frames/neighbours.hpp"

namespace dermis::learn::recognition {

ConnectedAreas::ConnectedAreas(const Lattice& lattice)
    : rows_(lattice.rows), cols_(lattice.cols), is_open_(lattice.taxels()) {
  pending_.reserve(lattice.taxels());
}

AreaCount ConnectedAreas::count(std::span<const double> image, double level) {
  for (std::size_t taxel = 0; taxel < is_open_.size(); ++taxel) is_open_[taxel] = image[taxel] > level ? 1 : 0;
  AreaCount areas;
  for (std::size_t taxel = 0; taxel < is_open_.size(); ++taxel) {
    if (is_open_[taxel] == 0) continue;
    ++areas.count;
    std::size_t size = area_of(taxel);
    if (size > areas.largest) std::swap(size, areas.largest);
    areas.second = std::max(areas.second, size);
  }
  return areas;
}

std::size_t ConnectedAreas::area_of(std::size_t first) {
  std::size_t size = 0;
  is_open_[first] = 0;
  pending_.assign(1, first);
  while (!pending_.empty()) {
    const std::size_t taxel = pending_.back();
    pending_.pop_back();
    ++size;
    for (const std::size_t near : Neighbours(rows_, cols_, taxel)) {
      if (is_open_[near] == 0) continue;
      is_open_[near] = 0;
      pending_.push_back(near);
    }
  }
  return size;
}

}  // namespace dermis::learn::recognition
