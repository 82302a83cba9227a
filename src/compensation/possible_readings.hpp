// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::compensation {

/// What a circuit can read, whatever the taxels are: of a taxel of 0 ohm alone, the current through its driver and its
/// sensed line.
class PossibleReadings {
 public:
  explicit PossibleReadings(const ArrayDescription& array);

  /// Taxels whose reading is beyond that become invalid; `sigma_ratio` is the noise of a reading. Allocates nothing.
  void check(std::span<const double> ratio, double sigma_ratio, std::span<TaxelStatus> taxels) const noexcept;

  /// The reading nearest to what the circuit can give, of those that are not invalid.
  [[nodiscard]] std::size_t largest(std::span<const double> ratio, std::span<const TaxelStatus> taxels) const noexcept;

 private:
  std::vector<double> most_ratio_;  // [taxels]; infinite where nothing limits it
};

}  // namespace dermis::compensation
