// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

struct AreaCount {
  std::size_t count = 0;
  std::size_t largest = 0;  ///< Taxels of the largest area.
  std::size_t second = 0;   ///< Taxels of the second largest.
};

/// Finds the areas of taxels above a level, each with its 8 neighbours. Not thread-safe.
class ConnectedAreas {
 public:
  explicit ConnectedAreas(const Lattice& lattice);

  [[nodiscard]] AreaCount count(std::span<const double> image, double level);

 private:
  std::size_t area_of(std::size_t first);

  std::size_t rows_;
  std::size_t cols_;
  std::vector<std::uint8_t> is_open_;
  std::vector<std::size_t> pending_;
};

}  // namespace dermis::learn::recognition
