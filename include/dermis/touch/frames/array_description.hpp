// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/film.hpp"
#include "dermis/touch/frames/line_order.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// Most rows, and most columns, of an array.
inline constexpr std::size_t kMaxLines = 1024;

/// Most temperature sensors with places of their own; more are one on each taxel.
inline constexpr std::size_t kMaxPlacedSensors = 64;

/// How the array is wired to the ADC. Drawings: docs/circuit-drawings.md.
enum class Circuit {
  divider,         ///< Every column ends in a resistor to ground; the ADC reads the column voltage.
  transimpedance,  ///< Every column is held at 0 V (virtual ground); the ADC reads its current times load_ohm.
  /// One column is driven, the others are at 0 V. One row ends in a resistor to ground and is read; the other rows
  /// float (FlexiTac, Sensitronics).
  flexitac,
  none,       ///< Unknown: readings are taken as proportional to conductance.
  automatic,  ///< "auto": calibration chooses the circuit that leaves least unexplained.
};

/// The quantity of a reading.
enum class Quantity {
  counts,    ///< Of the ADC.
  pressure,  ///< Kilopascals: another system has calibrated it.
  force,     ///< Newtons, the same.
};

/// State of the rows that are not being scanned.
enum class IdleRows {
  grounded,  ///< Through their drive resistance to 0 V.
  floating,  ///< To nothing.
};

/// State of the columns that are not being read.
enum class IdleColumns {
  loaded,    ///< In their load, like the one that is read.
  floating,  ///< In nothing: one load is switched from column to column.
};

/// A value that calibration is to find ("fit"); not a number, so nothing can compute with it.
inline constexpr double kFit = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kFitOhm = kFit;

/// A reading of the ADC and the one of an ideal ADC.
struct AdcPoint {
  double sent_counts = 0.0;
  double ideal_counts = 0.0;
};

/// In what an ADC and the multiplexer before it are not ideal (docs/circuits.md). Preprocessing undoes all of it in the
/// counts: the offset first, then the curve, then the settling.
struct AdcErrors {
  /// Share that a reading keeps of the voltage sampled before it, 0 ... 0.5, or kFit. Empty: none is known of.
  /// Frames of a device hold their readings in the order of its scan, which ArrayDescription::order turns.
  std::optional<double> settling;
  /// Sent counts above those of a straight ADC, or kFit. Empty: none are known of.
  std::optional<double> offset_counts;
  std::vector<AdcPoint> curve;  ///< At least two points, both columns rising; empty: straight.

  [[nodiscard]] bool any() const noexcept;         ///< Something is to be undone.
  [[nodiscard]] bool is_unknown() const noexcept;  ///< Something is kFit.
};

/// The path from taxel resistance to counts (the paper's Fig. 3). Lists with one value a line may be empty if the
/// circuit does not have that part. For `automatic` the driven lines are not known yet, so drive_ohm and load_ohm are
/// empty (to be fitted) or hold one value for all lines. Many members: one for each key of the table [readout].
struct Readout {
  Circuit circuit = Circuit::divider;
  /// Not counts: only with Circuit::none. Members in counts are then in this unit, and readings below 0 are valid.
  Quantity quantity = Quantity::counts;
  IdleRows idle_rows = IdleRows::grounded;         ///< divider, transimpedance
  IdleColumns idle_columns = IdleColumns::loaded;  ///< divider
  std::vector<double> drive_ohm;  ///< Resistance of the driver of each driven line [ohm], >= 0 or kFitOhm.
  std::vector<double> load_ohm;   ///< Divider or feedback resistor of each sensed line [ohm], > 0 or kFitOhm.
  /// Between a sensed line and its amplifier (transimpedance), or the one load that all share [ohm], >= 0.
  std::vector<double> column_switch_ohm;
  std::vector<double>
      amplifier_offset_v;                ///< transimpedance: input offset of a column's amplifier [V]; needs supply_v.
  std::optional<double> amplifier_gain;  ///< transimpedance: open-loop gain, >= 1; empty: ideal.
  std::vector<double> row_segment_ohm;   ///< For each row line, from one taxel to the next [ohm], >= 0.
  std::vector<double> column_segment_ohm;  ///< For each column line, from one taxel to the next [ohm], >= 0.
  std::optional<Film> film;                ///< Over all lines; empty: the sheet conducts at its crossings only.
  int adc_bits = 12;                       ///< Resolution [bit], 1 ... 24.
  double adc_noise_counts = 1.0;           ///< Standard deviation of a reading, rounding included [counts], > 0.
  std::vector<double> drive_error_ohm;     ///< Standard deviation of each of drive_ohm [ohm], >= 0; empty: exact.
  double drive_error_correlation = 0.0;    ///< Share of their variance that all drivers have in common, 0 ... 1.
  double supply_noise = 0.0;               ///< Relative standard deviation of the measured supply, 0 ... 0.1.
  std::optional<double> adc_reference_v;   ///< Full scale of the ADC [V], > 0; empty: the supply itself (ratiometric).
  std::optional<double> supply_v;          ///< Nominal supply [V], > 0, for frames that carry none.
  /// The supply's own resistance before all drivers [ohm], >= 0 or kFit: it carries the current of the driven line. The
  /// ADC's reference and the measured supply do not see its drop. Empty: none is known of.
  std::optional<double> supply_ohm;
  AdcErrors adc_errors;
  bool pressure_raises_reading = true;  ///< false: the reading falls with pressure, and 1 - ratio is used.
  /// Reading at which pressure saturates the readout [counts], 0 ... 2^adc_bits - 1; empty: the end of the ADC.
  std::optional<double> rail_counts;

  /// Largest count, 2^adc_bits - 1.
  [[nodiscard]] double full_scale_counts() const noexcept;
};

/// The place of a temperature sensor, between taxels by fractions: r0c0 is at {0, 0}.
struct TemperatureSensor {
  double row = 0.0;
  double col = 0.0;

  bool operator==(const TemperatureSensor&) const = default;
};

/// A resistive tactile array: rows are driven, columns are sensed (the other way round for `flexitac`); r0c0 is the
/// corner next to the connector.
struct ArrayDescription {
  std::string name = "array";
  std::size_t rows = 0;                 ///< 1 ... kMaxLines.
  std::size_t cols = 0;                 ///< 1 ... kMaxLines.
  double row_pitch_m = 0.010;           ///< Distance between neighbouring rows [m], 0.05 mm ... 1 m.
  double col_pitch_m = 0.010;           ///< Distance between neighbouring columns [m], 0.05 mm ... 1 m.
  std::optional<double> taxel_area_m2;  ///< Pressed area of a taxel [m2], 0.0025 mm2 ... 1 m2; needed for pressures.
  /// Crossings of lines where the sheet has no taxel, as row-major indices, rising. They conduct nothing, their
  /// readings are ignored and they have no force. Not all taxels may be absent.
  std::vector<std::size_t> absent;
  std::optional<Cover> cover;  ///< Over all taxels; empty: they feel what stands on them.
  /// Places on the sheet of those that RawFrame::sensor_celsius has: at most 64, or one on each taxel in their order.
  /// Empty: frames have one temperature for all taxels.
  std::vector<TemperatureSensor> temperature_sensors;
  /// By how much one end of the sheet may be warmer than the other, in any direction [C], 0 ... 100; 0: not known.
  double temperature_gradient_celsius = 0.0;
  Readout readout;
  LineOrder order;  ///< Which way round the device sends `rows` and `cols`. Frames in files are turned already.

  [[nodiscard]] std::size_t taxel_count() const noexcept { return rows * cols; }
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t col) const noexcept { return row * cols + col; }

  /// Number of lines with a driver: rows, or columns for `flexitac`.
  [[nodiscard]] std::size_t driven_lines() const noexcept { return readout.circuit == Circuit::flexitac ? cols : rows; }
  /// Number of lines with a load: columns, or rows for `flexitac`.
  [[nodiscard]] std::size_t sensed_lines() const noexcept { return readout.circuit == Circuit::flexitac ? rows : cols; }

  [[nodiscard]] bool is_absent(std::size_t taxel) const noexcept;

  /// Calibration still has to find the circuit or some of its resistances, so a reading cannot be computed yet.
  [[nodiscard]] bool has_unknown_circuit() const noexcept;

  /// "r3c5" for a row-major index.
  [[nodiscard]] std::string taxel_name(std::size_t taxel) const;

  /// Names the first field that is out of its range, as "readout.load_ohm: ...".
  [[nodiscard]] Status validate() const;
};

[[nodiscard]] const char* to_string(Circuit circuit) noexcept;
[[nodiscard]] const char* to_string(IdleRows idle_rows) noexcept;
[[nodiscard]] const char* to_string(IdleColumns idle_columns) noexcept;

/// One on each taxel, in their order.
[[nodiscard]] std::vector<TemperatureSensor> sensors_on_each_taxel(std::size_t rows, std::size_t cols);

/// "r3c5", as in the headers of the CSV files.
[[nodiscard]] std::string taxel_name(std::size_t row, std::size_t col);

}  // namespace dermis
