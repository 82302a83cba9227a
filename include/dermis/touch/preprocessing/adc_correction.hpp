// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::preprocessing {

/// Undoes in the counts in what an ADC is not ideal (AdcErrors, docs/circuits.md):
///
///   v_k = curve(sent_k - offset)             x_k = (v_k - s v_(k-1)) / (1 - s)
///
/// with s the settling and k the place of a reading in the scan, which is the order in which the device sends it. The
/// curve goes on beyond its ends with the slope 1. The first reading of a frame follows the last of the frame before.
/// After forget() and after a missing reading nothing is known of the voltage before: such a reading stays v_k. A
/// reading at the rail stays at the rail, and the next one follows the voltage of the rail. Not thread-safe: one per
/// stream.
class AdcCorrection {
 public:
  /// The array is valid, and nothing of its ADC is kFit.
  explicit AdcCorrection(const ArrayDescription& array);

  /// `counts` [rows, cols] as sent, NaN or outside of the ADC where missing: those stay. Valid until the next call.
  [[nodiscard]] std::span<const float> correct(std::span<const float> counts) noexcept;

  /// d v / d sent of each of these readings [rows, cols]; nothing where the ADC has no curve.
  void find_slopes(std::span<const float> counts, std::vector<float>& slopes) const;

  /// The frame before is not the one before the next.
  void forget() noexcept;

 private:
  [[nodiscard]] bool is_reading(float counts) const noexcept { return counts >= 0.0F && counts <= most_counts_; }
  [[nodiscard]] bool is_at_rail(float counts) const noexcept;
  [[nodiscard]] const AdcPoint* point_above(double sent_counts) const noexcept;
  [[nodiscard]] double straight(float counts) const noexcept;

  Readout readout_;
  float most_counts_;
  double kept_;                    // of the reading before
  std::vector<std::size_t> scan_;  // taxels in the order of their readings
  std::vector<float> ideal_;       // [rows, cols]
  double held_;                    // NaN: not known
};

/// Noise of a corrected reading over that of a sent one, where the ADC is straight: sqrt(1 + s^2) / (1 - s).
[[nodiscard]] double noise_gain(const AdcErrors& errors) noexcept;

}  // namespace dermis::touch::preprocessing
