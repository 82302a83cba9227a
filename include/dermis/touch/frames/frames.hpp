// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/force_sums.hpp"

/// The stages of a tactile frame. The stage is in the type: counts cannot be passed where newtons are meant.
/// Every per-taxel vector has the shape [rows, cols], row-major: index = row * cols + col.
namespace dermis {

/// Time since an arbitrary origin of the source (the first frame, the boot of the device, 1970).
using Nanos = std::chrono::nanoseconds;

/// The knowledge of one taxel in one frame.
enum class TaxelStatus : std::uint8_t {
  ok,
  saturated,    ///< The ADC is at the end of its range: the force is at least the one given.
  above_range,  ///< Beyond the heaviest calibrated load: extrapolated, at most to eight times that load.
  dead,         ///< Did not answer to its calibration loads: no force is given (NaN).
  line_fault,   ///< On an open or shorted line, or stuck: no force is given (NaN).
  invalid,      ///< No reading, one that the circuit cannot give, or the crosstalk has no solution: no force (NaN).
};

/// Outcome of a frame: a set of flags, empty when all is well.
enum class FrameStatus : std::uint16_t {
  ok = 0,
  rejected = 1U << 0U,     ///< Wrong shape, not a number, out of ADC range, an absurd supply or time going backwards.
  saturated = 1U << 1U,    ///< At least one taxel is saturated.
  above_range = 1U << 2U,  ///< At least one taxel is beyond its heaviest calibrated load.
  dead_taxels = 1U << 3U,  ///< The array has dead taxels.
  temperature_unknown = 1U << 4U,  ///< The frame has no temperature: the middle of the calibration is used.
  temperature_clamped = 1U << 5U,  ///< More than 1 C outside the calibrated temperatures: clamped to the nearest.
  not_converged = 1U << 6U,        ///< The crosstalk inversion found no solution within the noise.
  line_fault = 1U << 7U,      ///< A line or taxel is faulty: masked, the rest is solved with the fault in the model.
  supply_clamped = 1U << 8U,  ///< Outside the supplies of the calibration: the nearest is used, sigma grows.
  supply_implausible = 1U << 9U,  ///< More than 20 % from nominal, too: the nominal supply is used, sigma grows.
  doubtful = 1U << 10U,  ///< A reading jumped, and may be no press: its force is given with a sigma that says so.
};

[[nodiscard]] constexpr FrameStatus operator|(FrameStatus a, FrameStatus b) noexcept {
  return static_cast<FrameStatus>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr FrameStatus& operator|=(FrameStatus& a, FrameStatus b) noexcept {
  return a = a | b;
}
[[nodiscard]] constexpr bool has(FrameStatus status, FrameStatus flag) noexcept {
  return (static_cast<unsigned>(status) & static_cast<unsigned>(flag)) != 0;
}

/// "ok", or the flags joined with '+', as in the status column of forces.csv.
[[nodiscard]] std::string to_string(FrameStatus status);

/// Data on a frame besides its readings; empty or 0 if the source cannot know it.
struct Acquisition {
  std::optional<std::uint64_t> sequence;  ///< The device's number of the frame, counted on where it wraps.
  std::optional<Nanos> device_time;       ///< The device's clock, counted on where it wraps.
  Nanos arrival_steady{};                 ///< The host's steady clock when the last byte of the frame had come.
  Nanos arrival_utc{};                    ///< The host's UTC clock at that moment, since 1970.
  std::uint32_t lost_before = 0;          ///< Frames known to be lost between the frame before and this one.
  std::uint32_t held_taxels = 0;          ///< Taxels the device did not send: they keep their last reading (WiReSens).

  bool operator==(const Acquisition&) const = default;
};

/// Unit 1 -> 2. A frame as the device sent it.
struct RawFrame {
  /// When the frame was taken. A device's frames count from 1970 by the host's steady clock. UTC sets that clock once,
  /// when the source is opened, so time never goes back. If the device has a clock, its time is mapped to the host's.
  Nanos time{};
  std::optional<double> temperature_celsius;  ///< Temperature of the array [C]; empty where the source has none.
  std::optional<double> supply_v;             ///< Measured supply [V], > 0; empty where the source has none.
  std::vector<float> counts;  ///< ADC readings [counts], 0 ... 2^adc_bits - 1; fractional where a source averages.
  Acquisition acquisition{};
  /// Temperatures of ArrayDescription::temperature_sensors [C]; NaN: no reading.
  /// Empty where the source has one for all.
  std::vector<float> sensor_celsius{};
};

/// Unit 2 -> 3. Validated; the supply is divided out.
struct ConditionedFrame {
  Nanos time{};
  FrameStatus status = FrameStatus::ok;
  std::optional<double> temperature_celsius;
  std::vector<double> ratio;  ///< Reading / supply, rising with pressure; dimensionless, 0 ... reference / supply.
  double sigma_ratio = 0.0;   ///< Standard deviation of every ratio, rounding included.
  double noise_growth = 1.0;  ///< sigma_ratio over that of the calibrated noise, >= 1.
  /// Share of the variance of a ratio that it has in common with ratios of other driven lines, by their distance
  /// [driven lines]; first: with those of its own line. Empty: independent.
  std::vector<float> shared_noise{};
  std::vector<float> noise_gain;  ///< Factor on sigma_ratio for each ratio, where the ADC has a curve; empty: 1.
  double supply_doubt = 0.0;      ///< Relative standard deviation of a supply that is not trusted, beside its noise.
  std::vector<TaxelStatus> taxels;
  std::vector<float> taxel_celsius{};  ///< Temperature of each taxel [C]; empty: temperature_celsius is that of all.
};

/// Unit 3 -> 4. Crosstalk is removed.
struct ConductanceFrame {
  Nanos time{};
  FrameStatus status = FrameStatus::ok;
  std::optional<double> temperature_celsius;
  std::vector<double> siemens;        ///< Taxel conductance [S], >= 0; the bare ratio for `circuit = "none"`.
  std::vector<double> sigma_siemens;  ///< Standard deviation of each from noise of readings and supply [S].
  /// Certificate: no reading differs from the circuit's at `siemens` by more than this times its standard deviation.
  /// The reading of a taxel held at 0 is below instead.
  double residual_sigma = 0.0;
  std::vector<TaxelStatus> taxels;
  ConductanceErrors errors{};          ///< Before any drift is taken out.
  std::vector<float> taxel_celsius{};  ///< As in ConditionedFrame.

  /// Temperature of a taxel [C]; empty: not known.
  [[nodiscard]] std::optional<double> celsius(std::size_t taxel) const noexcept {
    return taxel_celsius.empty() ? temperature_celsius : std::optional(static_cast<double>(taxel_celsius[taxel]));
  }
};

/// Unit 4 ->. Forces for the robot.
struct ForceFrame {
  Nanos time{};
  FrameStatus status = FrameStatus::ok;
  std::vector<float> newtons;  ///< Normal force per taxel [N], >= 0; NaN where `taxels` says there is no force.
  /// Standard deviation of each [N], > 0. For an unloaded taxel it is the detection limit: the force that would just
  /// exceed the noise. Infinite where only a lower bound is known (saturated, more than eight times the heaviest
  /// calibrated load). NaN where `newtons` is.
  std::vector<float> sigma_newtons;
  std::vector<TaxelStatus> taxels;
  /// Signal of each taxel above the unloaded one, over the standard deviation of the additive noise of readings and
  /// zero. Uncertainty in proportion to the force (material, temperature) is not included: it widens sigma_newtons and
  /// does not affect contact detection. Around 0 where nothing presses, infinite where a reading is saturated, NaN
  /// where `newtons` is.
  std::vector<float> signal_to_noise{};
  ForceSums sums{};  ///< Empty where the frame was not made by unit 4; sums then are those of `newtons`.

  /// The force on the whole array. Use it in place of a sum of `newtons`, in which noise does not cancel. Taxels
  /// without a force are left out. The standard deviation counts what taxels share: noise through the circuit, supply,
  /// drivers, temperature. Allocates nothing after the first call of a thread.
  [[nodiscard]] TotalForce total() const noexcept;

  /// The same of some taxels: their indices, each once.
  [[nodiscard]] TotalForce total(std::span<const std::size_t> taxels) const noexcept;

  /// The same of several regions, one total each; common parts are computed once.
  void find_totals(std::span<const std::span<const std::size_t>> regions, std::span<TotalForce> totals) const noexcept;
};

}  // namespace dermis
