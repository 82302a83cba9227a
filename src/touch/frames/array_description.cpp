// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/array_description.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "dermis/touch/frames/millimetres.hpp"

namespace dermis {
namespace {

constexpr double kMostSupplyNoise = 0.1;
constexpr double kMostOfAllShares = 1.001;  // of a cover: they may be rounded
constexpr int kMaxAdcBits = 24;             // Counts are kept in float, which holds 24 bits exactly.

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

Status validate_size(const std::string& name, const std::vector<double>& values, std::size_t lines) {
  if (values.size() == lines) return Done{};
  return bad_input(name + ": has " + std::to_string(values.size()) + " values, the array needs " +
                   std::to_string(lines));
}

bool is_to_be_fitted(const std::vector<double>& ohms) {
  return std::any_of(ohms.begin(), ohms.end(), [](double ohm) { return std::isnan(ohm); });
}

Status validate_resistors(const char* field, const std::vector<double>& ohms, std::size_t lines, bool zero_allowed) {
  const std::string name = std::string("readout.") + field;
  if (Status size = validate_size(name, ohms, lines); !size) return size;
  for (const double ohm : ohms) {
    if (std::isnan(ohm)) continue;  // kFitOhm
    if (!is_positive(ohm) && !(zero_allowed && ohm == 0.0)) {
      return bad_input(name + ": must be " + (zero_allowed ? "0 or more" : "more than 0") + " ohm");
    }
  }
  return Done{};
}

/// A list that may be absent; its resistances are never fitted.
Status validate_extra_resistors(const char* field, const std::vector<double>& ohms, std::size_t lines) {
  if (ohms.empty()) return Done{};
  if (is_to_be_fitted(ohms)) return bad_input(std::string("readout.") + field + ": must be 0 or more ohm");
  return validate_resistors(field, ohms, lines, true);
}

bool has_column_switches(const Readout& readout) {
  return readout.circuit == Circuit::transimpedance || readout.circuit == Circuit::flexitac ||
         readout.idle_columns == IdleColumns::floating;
}

Status validate_switches(const ArrayDescription& array) {
  const std::vector<double>& ohms = array.readout.column_switch_ohm;
  if (!ohms.empty() && !has_column_switches(array.readout)) {
    return bad_input(
        "readout.column_switch_ohm: carries no current where each column has its load; leave it out, or set "
        "idle_columns = \"floating\"");
  }
  return validate_extra_resistors("column_switch_ohm", ohms, array.sensed_lines());
}

Status validate_amplifiers(const Readout& readout, std::size_t cols) {
  const bool has_parts = !readout.amplifier_offset_v.empty() || readout.amplifier_gain;
  if (has_parts && readout.circuit != Circuit::transimpedance) {
    return bad_input("readout.circuit: amplifier_offset_v and amplifier_gain belong to \"transimpedance\"");
  }
  if (readout.amplifier_gain && !(std::isfinite(*readout.amplifier_gain) && *readout.amplifier_gain >= 1.0)) {
    return bad_input("readout.amplifier_gain: must be 1 or more; leave it out for an ideal amplifier");
  }
  if (readout.amplifier_offset_v.empty()) return Done{};
  const std::string name = "readout.amplifier_offset_v";
  if (Status size = validate_size(name, readout.amplifier_offset_v, cols); !size) return size;
  if (!readout.supply_v) return bad_input(name + ": needs readout.supply_v, the nominal supply");
  for (const double volt : readout.amplifier_offset_v) {
    if (!(std::abs(volt) < *readout.supply_v)) return bad_input(name + ": must be less than the supply");
  }
  return Done{};
}

/// Which lines have drivers, and so how many, is not known before the circuit is: one value stands for all.
Status validate_automatic(const Readout& readout) {
  if (!readout.row_segment_ohm.empty() || !readout.column_segment_ohm.empty()) {
    return bad_input("readout.circuit: \"auto\" takes lines for ideal; leave out the segment resistances");
  }
  if (!readout.drive_error_ohm.empty()) {
    return bad_input("readout.drive_error_ohm: \"auto\" finds it; leave it out");
  }
  if (!readout.drive_ohm.empty()) {
    if (Status drive = validate_resistors("drive_ohm", readout.drive_ohm, 1, true); !drive) return drive;
  }
  if (readout.load_ohm.empty()) return Done{};
  return validate_resistors("load_ohm", readout.load_ohm, 1, false);
}

/// 0.015 where the file has no more digits.
std::string short_text(double value) {
  constexpr int kDigits = 7;
  std::ostringstream text;
  text << std::setprecision(kDigits) << value;
  return text.str();
}

/// A value far from all skins and mats was written in another unit.
Status validate_geometry(const ArrayDescription& array) {
  constexpr double kLeastPitchMm = 0.05;
  constexpr double kMostPitchMm = 1000.0;
  const auto check = [](const std::string& key, double metres, double per_metre, double least, double most) -> Status {
    const auto is_possible = [&](double value) { return value >= least && value <= most; };
    const double value = per_metre * metres;
    if (is_possible(value)) return Done{};
    std::string text = key + ": must be " + short_text(least) + " to " + short_text(most);
    if (is_possible(per_metre * value)) {
      text += "; is " + short_text(value) + " in metres? Then write " + short_text(per_metre * value);
    }
    return bad_input(text);
  };
  for (const double pitch_m : {array.row_pitch_m, array.col_pitch_m}) {
    Status valid = check("array.pitch_mm", pitch_m, kMillimetresPerMetre, kLeastPitchMm, kMostPitchMm);
    if (!valid) return valid;
  }
  if (!array.taxel_area_m2) return Done{};
  return check("array.taxel_area_mm2", *array.taxel_area_m2, kMillimetresPerMetre * kMillimetresPerMetre,
               kLeastPitchMm * kLeastPitchMm, kMostPitchMm * kMostPitchMm);
}

Status validate_absent(const ArrayDescription& array) {
  const std::vector<std::size_t>& absent = array.absent;
  if (std::adjacent_find(absent.begin(), absent.end(), std::greater_equal<>()) != absent.end()) {
    return bad_input("array.absent: must name each taxel once, row by row");
  }
  if (!absent.empty() && absent.back() >= array.taxel_count()) {
    return bad_input("array.absent: must name taxels of the array");
  }
  if (absent.size() == array.taxel_count()) return bad_input("array.absent: must leave at least one taxel");
  return Done{};
}

Status validate_temperatures(const ArrayDescription& array) {
  constexpr std::size_t kMostWeights = std::size_t{1} << 22U;  // of sensors for taxels
  constexpr double kMostGradientCelsius = 100.0;
  const double gradient = array.temperature_gradient_celsius;
  if (!(gradient >= 0.0 && gradient <= kMostGradientCelsius)) {
    return bad_input("array.temperature_gradient_celsius: must be 0 to 100 C");
  }
  const auto is_on_line = [](double place, std::size_t lines) {
    return place >= 0.0 && place <= static_cast<double>(lines - 1);
  };
  for (const auto& [row, col] : array.temperature_sensors) {
    if (is_on_line(row, array.rows) && is_on_line(col, array.cols)) continue;
    return bad_input("array.temperature_sensors: must be places [row, col] on the array, from [0, 0] on");
  }
  const std::size_t most = std::min(kMaxPlacedSensors, std::max<std::size_t>(1, kMostWeights / array.taxel_count()));
  if (array.temperature_sensors.size() <= most) return Done{};
  if (array.temperature_sensors == sensors_on_each_taxel(array.rows, array.cols)) return Done{};
  return bad_input("array.temperature_sensors: must be at most " + std::to_string(most) + ", or \"each taxel\"");
}

Status validate_order(const ArrayDescription& array) {
  const auto of_key = [](const Error& error) { return bad_input("array." + error.message); };
  if (array.order.skip_columns >= kMaxLines) {
    return bad_input("array.skip_columns: must be 0 to " + std::to_string(kMaxLines - 1));
  }
  if (const Status lists = array.order.validate(); !lists) return of_key(lists.error());
  const Result<FrameShape> turned = array.order.turned(array.order.sent({array.rows, array.cols}));
  return turned ? Status(Done{}) : of_key(turned.error());
}

/// Pressures and forces, which no circuit and no supply has part in.
Status validate_calibrated(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  if (readout.quantity == Quantity::counts) return Done{};
  if (readout.circuit != Circuit::none) return bad_input("readout.circuit: readings that are forces have no circuit");
  if (readout.adc_reference_v) return bad_input("readout.adc_reference_v: belongs to counts; leave it out");
  if (readout.adc_errors.any() || readout.adc_errors.is_unknown()) {
    return bad_input(
        "readout.circuit: errors of an ADC belong to counts; leave adc_settling, adc_offset_counts and "
        "adc_curve out");
  }
  if (!readout.pressure_raises_reading) {
    return bad_input("readout.pressure_raises_reading: belongs to counts; leave it out");
  }
  if (readout.quantity == Quantity::force || array.taxel_area_m2) return Done{};
  return bad_input("array.taxel_area_mm2: is needed where readings are pressures");
}

Status validate_curve(const std::vector<AdcPoint>& curve) {
  if (curve.size() == 1) return bad_input("readout.adc_curve: needs at least two points");
  const auto rises = [](const AdcPoint& a, const AdcPoint& b) {
    return a.sent_counts < b.sent_counts && a.ideal_counts < b.ideal_counts;
  };
  for (std::size_t k = 1; k < curve.size(); ++k) {
    if (!rises(curve[k - 1], curve[k])) {
      return bad_input("readout.adc_curve: both columns must rise from point to point; point " + std::to_string(k) +
                       " does not");
    }
  }
  return Done{};
}

Status validate_adc_errors(const Readout& readout) {
  constexpr double kMostSettling = 0.5;
  const AdcErrors& errors = readout.adc_errors;
  const double settling = errors.settling.value_or(0.0);
  if (!std::isnan(settling) && !(settling >= 0.0 && settling <= kMostSettling)) {
    return bad_input("readout.adc_settling: must be 0 to 0.5, the share that a reading keeps of the one before it");
  }
  const double offset = errors.offset_counts.value_or(0.0);
  if (!std::isnan(offset) && !(std::abs(offset) < readout.full_scale_counts())) {
    return bad_input("readout.adc_offset_counts: must be less than 2^adc_bits - 1");
  }
  return validate_curve(errors.curve);
}

Status validate_supply_ohm(const Readout& readout) {
  if (!readout.supply_ohm) return Done{};
  if (readout.circuit == Circuit::none) return bad_input("readout.supply_ohm: needs a circuit; leave it out");
  if (!readout.amplifier_offset_v.empty()) {
    return bad_input("readout.supply_ohm: cannot be given beside amplifier_offset_v; leave one of them out");
  }
  return validate_resistors("supply_ohm", {*readout.supply_ohm}, 1, true);
}

/// Not known yet, or films as they are made.
Status validate_film(const Readout& readout) {
  if (!readout.film) return Done{};
  const Film& film = *readout.film;
  if (readout.circuit == Circuit::none) return bad_input("readout.film_ohm: needs a circuit; leave it out");
  if (!is_positive(film.loaded_newtons)) return bad_input("readout.film_force_n: must be more than 0 N");
  if (film.is_unknown()) return Done{};
  if (!is_positive(film.unloaded_ohm) || !is_positive(film.loaded_ohm)) {
    return bad_input("readout.film_ohm: must be more than 0 ohm");
  }
  if (film.loaded_ohm <= film.unloaded_ohm) return Done{};
  return bad_input("readout.film_ohm: must be [unloaded, loaded], and a load lowers the resistance of a film");
}

Status validate_converter(const Readout& readout) {
  if (readout.adc_bits < 1 || readout.adc_bits > kMaxAdcBits) {
    return bad_input("readout.adc_bits: must be 1 to " + std::to_string(kMaxAdcBits));
  }
  if (readout.adc_reference_v && !is_positive(*readout.adc_reference_v)) {
    return bad_input("readout.adc_reference_v: must be more than 0 V");
  }
  if (readout.supply_v && !is_positive(*readout.supply_v)) {
    return bad_input("readout.supply_v: must be more than 0 V");
  }
  if (readout.rail_counts && !(*readout.rail_counts >= 0.0 && *readout.rail_counts <= readout.full_scale_counts())) {
    return bad_input("readout.rail_counts: must be a reading of the ADC, 0 to 2^adc_bits - 1");
  }
  if (!is_positive(readout.adc_noise_counts)) return bad_input("readout.adc_noise_counts: must be more than 0");
  if (!(readout.supply_noise >= 0.0 && readout.supply_noise <= kMostSupplyNoise)) {
    return bad_input("readout.supply_noise: must be 0 to 0.1");
  }
  if (!(readout.drive_error_correlation >= 0.0 && readout.drive_error_correlation <= 1.0)) {
    return bad_input("readout.drive_error_correlation: must be 0 to 1");
  }
  return Done{};
}

Status validate_readout(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  if (Status valid = validate_converter(readout); !valid) return valid;
  if (Status valid = validate_calibrated(array); !valid) return valid;
  if (Status valid = validate_adc_errors(readout); !valid) return valid;
  if (Status valid = validate_supply_ohm(readout); !valid) return valid;
  if (Status valid = validate_film(readout); !valid) return valid;
  if (readout.circuit == Circuit::none) return Done{};
  if (readout.idle_columns == IdleColumns::floating && readout.circuit != Circuit::divider) {
    return bad_input("readout.idle_columns: belongs to circuit = \"divider\"");
  }
  if (Status valid = validate_switches(array); !valid) return valid;
  if (Status valid = validate_amplifiers(readout, array.cols); !valid) return valid;
  if (readout.circuit == Circuit::automatic) return validate_automatic(readout);
  if (Status drive = validate_resistors("drive_ohm", readout.drive_ohm, array.driven_lines(), true); !drive) {
    return drive;
  }
  if (Status error = validate_extra_resistors("drive_error_ohm", readout.drive_error_ohm, array.driven_lines());
      !error) {
    return error;
  }
  if (Status load = validate_resistors("load_ohm", readout.load_ohm, array.sensed_lines(), false); !load) return load;
  if (Status row = validate_extra_resistors("row_segment_ohm", readout.row_segment_ohm, array.rows); !row) return row;
  return validate_extra_resistors("column_segment_ohm", readout.column_segment_ohm, array.cols);
}

/// Not known yet, or shares of one force.
Status validate_cover(const ArrayDescription& array) {
  constexpr double kMostSpreadM = 1.0;
  if (!array.cover || array.cover->is_unknown()) return Done{};
  const Cover& cover = *array.cover;
  if (cover.shares.empty()) {
    if (cover.spread_m >= 0.0 && cover.spread_m <= kMostSpreadM) return Done{};
    return bad_input("array.cover_spread_mm: must be 0 to 1000");
  }
  double sum = 0.0;
  double centre = 0.0;
  for (const auto& [rows, cols, share] : cover.shares) {
    if (rows >= kMaxLines || cols >= kMaxLines || !(share >= 0.0)) {
      return bad_input("array.cover_shares: must be [rows away, columns away, share], the share 0 or more");
    }
    sum += share * (rows > 0 ? 2.0 : 1.0) * (cols > 0 ? 2.0 : 1.0);
    if (rows == 0 && cols == 0) centre = share;
  }
  if (centre > 0.0 && sum <= kMostOfAllShares) return Done{};
  return bad_input("array.cover_shares: must have [0, 0, share], and no more than 1 in all four directions together");
}

}  // namespace

double Readout::full_scale_counts() const noexcept {
  return std::ldexp(1.0, adc_bits) - 1.0;
}

bool AdcErrors::any() const noexcept {
  return settling.value_or(0.0) != 0.0 || offset_counts.value_or(0.0) != 0.0 || !curve.empty();
}

bool AdcErrors::is_unknown() const noexcept {
  return std::isnan(settling.value_or(0.0)) || std::isnan(offset_counts.value_or(0.0));
}

bool ArrayDescription::is_absent(std::size_t taxel) const noexcept {
  return std::binary_search(absent.begin(), absent.end(), taxel);
}

bool ArrayDescription::has_unknown_circuit() const noexcept {
  if (readout.adc_errors.is_unknown()) return true;
  if (readout.circuit == Circuit::none) return false;
  if (readout.film && readout.film->is_unknown()) return true;
  return readout.circuit == Circuit::automatic || is_to_be_fitted(readout.drive_ohm) ||
         is_to_be_fitted(readout.load_ohm) || std::isnan(readout.supply_ohm.value_or(0.0));
}

std::string ArrayDescription::taxel_name(std::size_t taxel) const {
  return dermis::taxel_name(taxel / cols, taxel % cols);
}

Status ArrayDescription::validate() const {
  if (rows < 1 || rows > kMaxLines) return bad_input("array.rows: must be 1 to " + std::to_string(kMaxLines));
  if (cols < 1 || cols > kMaxLines) return bad_input("array.cols: must be 1 to " + std::to_string(kMaxLines));
  if (Status valid = validate_geometry(*this); !valid) return valid;
  if (Status valid = validate_absent(*this); !valid) return valid;
  if (Status valid = validate_cover(*this); !valid) return valid;
  if (Status valid = validate_temperatures(*this); !valid) return valid;
  if (Status valid = validate_order(*this); !valid) return valid;
  return validate_readout(*this);
}

const char* to_string(Circuit circuit) noexcept {
  switch (circuit) {
    case Circuit::divider: return "divider";
    case Circuit::transimpedance: return "transimpedance";
    case Circuit::flexitac: return "flexitac";
    case Circuit::none: return "none";
    case Circuit::automatic: return "auto";
  }
  return "none";
}

const char* to_string(IdleColumns idle_columns) noexcept {
  return idle_columns == IdleColumns::loaded ? "loaded" : "floating";
}

const char* to_string(IdleRows idle_rows) noexcept {
  return idle_rows == IdleRows::grounded ? "grounded" : "floating";
}

std::vector<TemperatureSensor> sensors_on_each_taxel(std::size_t rows, std::size_t cols) {
  std::vector<TemperatureSensor> sensors;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      sensors.push_back({static_cast<double>(row), static_cast<double>(col)});
    }
  }
  return sensors;
}

std::string taxel_name(std::size_t row, std::size_t col) {
  return "r" + std::to_string(row) + "c" + std::to_string(col);
}

}  // namespace dermis
