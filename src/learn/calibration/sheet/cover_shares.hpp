// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/sheet/single_presses.hpp"
#include "learn/calibration/sheet/taxel_curves.hpp"

namespace dermis::learn::calibration {

/// The force that taxels feel so far from a press, over that of the pressed one.
struct RelativeShare {
  double share = 0.0;
  double error = 0.0;     ///< Standard error.
  double least = 0.0;     ///< In one of the directions (left or right, up or down).
  double scatter = 0.0;   ///< Relative deviation of a typical pair of taxels.
  std::size_t pairs = 0;  ///< Of taxels.
};

/// Shares by distance, from presses of single taxels. Refers to all its arguments.
class CoverShares {
 public:
  CoverShares(const ArrayDescription& array, const SinglePresses& single, const TaxelCurves& curves);

  /// The share of taxels `rows` and `cols` away, not both 0.
  [[nodiscard]] RelativeShare at(std::size_t rows, std::size_t cols) const;

 private:
  struct Place {
    std::size_t first = 0;  // of its presses
    std::size_t last = 0;
  };

  [[nodiscard]] std::vector<double> of_direction(std::ptrdiff_t rows, std::ptrdiff_t cols) const;
  [[nodiscard]] double of_pair(const Place& pressed, std::size_t beside) const;

  const ArrayDescription& array_;
  const SinglePresses& single_;
  const TaxelCurves& curves_;
  std::vector<Place> places_;  // by taxel
};

}  // namespace dermis::learn::calibration
