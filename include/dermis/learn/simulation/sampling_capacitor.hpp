// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::simulation {

/// The capacitor behind the multiplexer, at which the ADC reads. It has no time to settle, so it keeps the share s =
/// AdcErrors::settling of the voltage of the reading before. Readings follow each other in the order in which the
/// device sends them:
///   held = (1 - s) input + s held_before
/// The first reading of a frame follows the last of the frame before. The first of all finds the capacitor at its own
/// voltage. Not thread-safe.
class SamplingCapacitor {
 public:
  /// The array is valid and its settling a number.
  explicit SamplingCapacitor(const ArrayDescription& array);

  /// `ratio` [rows, cols], readings over the supply: those that come in, then those that are held.
  void sample(std::span<double> ratio, double supply_v);

 private:
  double kept_;
  std::vector<std::size_t> scan_;  // taxels in the order of their readings
  std::optional<double> held_v_;
};

}  // namespace dermis::learn::simulation
