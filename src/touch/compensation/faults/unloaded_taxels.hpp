// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/touch.hpp"
#include "touch/compensation/faults/line_sums.hpp"
#include "touch/compensation/faults/taxel_block.hpp"

namespace dermis::touch::compensation {

/// Standard deviations: hum may take so much from a reading for long, so what should read less tells nothing.
[[nodiscard]] inline double hum_sigmas(double noise_growth) {
  return std::sqrt(1.0 - 1.0 / (noise_growth * noise_growth));
}

inline constexpr double kUnloadedShare = 0.3;  // of the unloaded conductance: temperature, memory, age leave at least
inline constexpr double kRoundedToNone = 0.5;  // of a count, in every frame, whatever the described noise

/// The readings of taxels that nothing presses.
class UnloadedTaxels {
 public:
  /// `siemens`: see LineFaultMonitor.
  UnloadedTaxels(const ArrayDescription& array, std::span<const double> siemens);

  /// Finds least_reading() of this frame, from the share that pressed taxels take from the others of their lines.
  void expect(const ConditionedFrame& conditioned, const LineSums& sums, std::size_t frame, bool solved) noexcept;

  /// Conductance of every taxel; 0 where it is not known.
  [[nodiscard]] std::span<const double> siemens() const noexcept { return siemens_; }

  /// Readings while nothing is pressed.
  [[nodiscard]] std::span<const double> ratio() const noexcept { return ratio_; }

  /// Least reading of an unloaded taxel while nothing is pressed.
  [[nodiscard]] double least_ratio(std::size_t taxel) const noexcept {
    return kUnloadedShare * ratio_[taxel] - taken_off(taxel);
  }

  /// Least reading of every unloaded taxel among the loads of this frame [standard deviations]. 0 where none can be
  /// expected: the readout has never sent so small a reading, and may cut it off by what the calibration saw.
  [[nodiscard]] std::span<const float> least_reading() const noexcept { return least_reading_; }

  /// The smallest of all readings above 0 so far: a readout that cuts readings off does so below it.
  [[nodiscard]] double smallest_reading() const noexcept { return smallest_reading_; }

  /// The largest conductance of an unloaded taxel, at this standard deviation of it.
  [[nodiscard]] static double most_siemens(double unloaded_siemens, double sigma_siemens) noexcept {
    return touched_above(unloaded_siemens, sigma_siemens, kMostSigmas);
  }
  [[nodiscard]] double most_siemens(std::size_t taxel, double sigma_siemens) const noexcept {
    return most_siemens(siemens_[taxel], sigma_siemens);
  }

 private:
  static constexpr double kMostSigmas = 5.0;

  void subtract_amplifier_offsets();
  [[nodiscard]] double least_sent_reading() const;
  [[nodiscard]] double taken_off(std::size_t taxel) const noexcept {
    return taken_off_.empty() ? 0.0 : taken_off_[taxel % array_.cols];
  }
  void take_off(double sigma_ratio) noexcept;
  void follow_smallest_reading(std::span<const double> ratio, const TaxelBlock& block) noexcept;
  void follow_fading(const ConditionedFrame& conditioned, const TaxelBlock& block) noexcept;
  void forget_what_may_be_cut_off(const ConditionedFrame& conditioned) noexcept;
  void expect_beside_presses(const LineSums& sums, double sigma_ratio, bool solved) noexcept;
  void expect_beside_no_press(const ConditionedFrame& conditioned) noexcept;
  void find_pressed_lines(const ConditionedFrame& conditioned) noexcept;

  const ArrayDescription& array_;
  double smallest_reading_;                           // > 0, of all frames
  double sent_reading_ = 0.0;                         // > 0: the device has sent less, by the calibration
  double faded_share_ = 0.0;                          // of the taxels that read: less than unloaded ones
  std::vector<double> siemens_;                       // [taxels]
  std::vector<double> ratio_;                         // [taxels]
  std::vector<double> taken_off_;                     // by offsets of the amplifiers [cols]; empty without
  std::vector<float> least_reading_;                  // [taxels]
  std::vector<double> left_;                          // share of the supply that is left on a sensed line
  PerAxis<std::vector<std::uint8_t>> pressed_lines_;  // in an unknown circuit
};

}  // namespace dermis::touch::compensation
