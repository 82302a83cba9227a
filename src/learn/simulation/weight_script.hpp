// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::simulation {

/// Two weights of 5 and 10 N, laid on one taxel after another: the scene "two_weights". Thread-safe.
class WeightScript {
 public:
  struct Moment {
    std::size_t taxel = 0;
    double force_n = 0.0;
    bool is_known = true;  ///< No weight is being put on or taken off.
  };

  /// `taxels`: how many different ones, at most those that are not absent.
  WeightScript(const ArrayDescription& array, std::size_t taxels, std::uint64_t seed);

  [[nodiscard]] static double seconds(std::size_t taxels);
  [[nodiscard]] Moment at(double time_s) const;  ///< 0 <= time_s < seconds()

 private:
  std::vector<std::size_t> taxels_;
};

}  // namespace dermis::learn::simulation
