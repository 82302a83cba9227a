// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::simulation {

/// The analogue-to-digital converter:
///   counts = round(sent(ratio supply / reference (2^bits - 1)) + noise_lsb N(0,1)), clamped to 0 ... 2^bits - 1.
/// The reference is Readout::adc_reference_v, or the supply itself where that is empty. sent() turns the counts of an
/// ideal ADC into those of AdcErrors::curve, beyond whose ends the slope is 1, and adds the offset. Thread-safe.
class Adc {
 public:
  /// `noise_lsb`: standard deviation of the noise before rounding [counts], >= 0.
  Adc(const Readout& readout, double noise_lsb);

  /// `ratio`: readings over the supply; `supply_v` > 0 [V]; `counts` has the same shape. One random number a reading.
  void convert(std::span<const double> ratio, double supply_v, Random& random, std::span<float> counts) const;

 private:
  [[nodiscard]] double sent(double ideal_counts) const;

  double full_scale_counts_;
  std::optional<double> reference_v_;
  double noise_lsb_;
  AdcErrors errors_;
};

}  // namespace dermis::learn::simulation
