// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/simulation/touch_place.hpp"

namespace dermis::learn::simulation {

/// Touches that rise, hold, give way and return: the scene "touches". A longer script begins with the shorter one.
/// Thread-safe.
class TouchScript {
 public:
  TouchScript(const ArrayDescription& array, double seconds, std::uint64_t seed);

  /// Adds the force on each taxel [N] at a moment from 0 s on to `force_n`, [rows, cols].
  void add_forces(double time_s, std::vector<double>& force_n) const;

 private:
  struct Corner {
    double time_s;
    double force_n;
  };

  struct Touch {
    TouchPlace place{};
    std::vector<Corner> corners{};  ///< Straight lines between them; the first and the last have no force.

    [[nodiscard]] double force(double time_s) const;
  };

  [[nodiscard]] std::vector<Touch> draw_slot(std::size_t slot, double seconds, Random& random) const;

  ArrayDescription array_;
  std::vector<std::vector<Touch>> slots_;  // One touch at a time in each, by their time.
};

}  // namespace dermis::learn::simulation
