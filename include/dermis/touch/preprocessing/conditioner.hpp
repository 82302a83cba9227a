// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/preprocessing/adc_correction.hpp"
#include "dermis/touch/preprocessing/supply_bounds.hpp"
#include "dermis/touch/preprocessing/temperature_field.hpp"

namespace dermis::touch::preprocessing {

/// Why a frame was rejected.
enum class Rejection {
  none,
  wrong_shape,           ///< Not rows x cols readings.
  not_a_number,          ///< The supply is NaN or infinite, or the temperature infinite.
  too_few_readings,      ///< More than half of the taxels have no reading.
  supply_not_positive,   ///< A measured supply of 0 V or less.
  supply_impossible,     ///< A measured supply that the readout cannot have (SupplyBounds).
  supply_in_millivolts,  ///< The same, and it would be possible as millivolts.
  supply_unknown,        ///< The ADC has a reference in volts, and neither the frame nor the array has a supply.
  time_going_backwards,  ///< Earlier than the frame before it.
};

[[nodiscard]] const char* to_string(Rejection rejection) noexcept;

/// Unit 2 of the paper, Data Pre-Processing. It validates a raw frame and "converts raw sensor data into the needed
/// data formats". Counts become a ratio of the supply, so fluctuation of the supply is removed before the circuit is
/// solved.
///
///   ratio = counts / (2^adc_bits - 1) * adc_reference_v / supply_v     (where the reference is the supply, or the
///   circuit
///                                                                       and the supply are unknown, the factor is 1)
///
/// and 1 - ratio if pressure lowers the reading. Errors of the ADC against an ideal one are undone in the counts first
/// (AdcCorrection). Pressure drives readings to one end of the ADC, or to readout.rail_counts. Readings within half a
/// count of that end, or beyond it, are marked saturated. A taxel has no reading if it is NaN, infinite, above
/// 2^adc_bits - 1, or below 0 where readings are counts. It is invalid and gets the mean ratio of its neighbours that
/// have one. A taxel that the sheet does not have is invalid and has the ratio 0. A temperature of NaN is none. Where
/// the array has several sensors, each taxel gets its temperature (TemperatureField), and the frame the mean of them.
///
/// A supply outside of the trusted ones (SupplyBounds) is replaced by the nearest of them, or by nominal. The frame
/// then has the status supply_clamped or supply_implausible, and supply_doubt says how far that is. Not thread-safe:
/// one conditioner per stream of frames.
class Conditioner {
 public:
  /// The array must be valid (ArrayDescription::validate). A reference in volts needs a supply, either nominal
  /// (readout.supply_v) or in every frame.
  /// This one is for a calibration: every supply that is possible is used as it is.
  explicit Conditioner(const ArrayDescription& array);
  /// For an array at work. `calibrated`: the supplies of its calibration; empty: not known.
  Conditioner(const ArrayDescription& array, const std::optional<SupplyRange>& calibrated);

  /// Allocates nothing once `conditioned` has the array's size. A rejected frame has the status `rejected` and only
  /// invalid taxels. Time is compared with the last accepted frame, or with the one that went back. So a clock that
  /// jumps costs one frame.
  void process(const RawFrame& raw, ConditionedFrame& conditioned) noexcept;

  /// Why the last frame was rejected.
  [[nodiscard]] Rejection rejection() const noexcept { return rejection_; }
  /// The same in words, with the supply where that was the reason; empty: it was not rejected.
  [[nodiscard]] std::string why_rejected() const;

  [[nodiscard]] const SupplyBounds& supply_bounds() const noexcept { return supply_bounds_; }

 private:
  Conditioner(const ArrayDescription& array, const SupplyBounds& supply_bounds);
  [[nodiscard]] bool is_reading(float count) const noexcept {
    return count >= least_counts_ && count <= full_scale_counts_;
  }
  [[nodiscard]] std::size_t count_missing(const RawFrame& raw) const noexcept;
  [[nodiscard]] Rejection inspect(const RawFrame& raw) const noexcept;
  [[nodiscard]] Rejection inspect_supply(const RawFrame& raw) const noexcept;
  void find_temperatures(const RawFrame& raw, ConditionedFrame& conditioned) noexcept;
  void convert(const RawFrame& raw, ConditionedFrame& conditioned) noexcept;
  void doubt_supply(double measured_v, ConditionedFrame& conditioned) const noexcept;
  void mark_saturated(const RawFrame& raw, ConditionedFrame& conditioned) const noexcept;
  void mark_missing(const RawFrame& raw, ConditionedFrame& conditioned) const noexcept;

  ArrayDescription array_;
  SupplyBounds supply_bounds_;
  std::optional<AdcCorrection> adc_;              // empty: it is ideal
  std::optional<TemperatureField> temperatures_;  // empty: frames have one temperature
  float full_scale_counts_;
  float least_counts_;
  float highest_counts_;  // readings above it are saturated
  float lowest_counts_;   // and those below it
  std::optional<Nanos> last_time_;
  Rejection rejection_ = Rejection::none;
  double rejected_supply_v_ = 0.0;  // where that is the reason
};

/// counts / full scale, or 1 minus that if pressure lowers the reading. An estimator that knows neither the supply nor
/// the circuit uses it. `reading` [rows, cols] is in [0, 1], 0 if there is none. The frame must have the array's shape.
/// Thread-safe.
void bare_readings(const ArrayDescription& array, const RawFrame& raw, std::span<double> reading) noexcept;

}  // namespace dermis::touch::preprocessing
