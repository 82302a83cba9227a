// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/array_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bytes/files/sheet_toml.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {
namespace {

constexpr double kSquareMillimetresPerSquareMetre = 1e6;
constexpr int kMostAdcBits = 24;  // which a float holds exactly
constexpr const char* kPressure = "pressure";
constexpr const char* kForce = "force";
constexpr const char* kInputPullup = "input_pullup";
constexpr const char* kEachTaxel = "each taxel";

void read_line_count(ConfigFile& file, std::string_view key, std::size_t& lines) {
  file.require(key);
  file.count(key, lines);
  if (lines >= 1 && lines <= kMaxLines) return;
  file.fail(key, fmt::format("must be 1 to {}", kMaxLines));
  lines = 1;
}

void read_geometry(ConfigFile& file, ArrayDescription& array) {
  file.text("array.name", array.name);
  read_line_count(file, "array.rows", array.rows);
  read_line_count(file, "array.cols", array.cols);
  std::vector<double> pitch_mm{array.row_pitch_m * kMillimetresPerMetre, array.col_pitch_m * kMillimetresPerMetre};
  file.numbers("array.pitch_mm", 2, pitch_mm);
  array.row_pitch_m = pitch_mm[0] / kMillimetresPerMetre;
  array.col_pitch_m = pitch_mm[1] / kMillimetresPerMetre;
  file.number("array.taxel_area_mm2", array.taxel_area_m2);
  if (array.taxel_area_m2) *array.taxel_area_m2 /= kSquareMillimetresPerSquareMetre;
}

void read_absent(ConfigFile& file, ArrayDescription& array) {
  std::vector<std::string> names;
  file.texts("array.absent", names);
  for (const std::string& name : names) {
    const Result<TaxelRegion> region = parse_region(name, {array.rows, array.cols});
    if (!region) return file.fail("array.absent", region.error().message);
    const std::vector<std::size_t> taxels = taxel_indices(*region, array.cols);
    array.absent.insert(array.absent.end(), taxels.begin(), taxels.end());
  }
  std::sort(array.absent.begin(), array.absent.end());
  array.absent.erase(std::unique(array.absent.begin(), array.absent.end()), array.absent.end());
}

/// "each taxel", or [[row, col], ...].
void read_temperatures(ConfigFile& file, ArrayDescription& array) {
  file.number("array.temperature_gradient_celsius", array.temperature_gradient_celsius);
  if (file.is_text("array.temperature_sensors", kEachTaxel)) {
    array.temperature_sensors = sensors_on_each_taxel(array.rows, array.cols);
    return;
  }
  std::vector<std::vector<double>> places;
  file.number_rows("array.temperature_sensors", 2, places);
  for (const std::vector<double>& place : places) array.temperature_sensors.push_back({place[0], place[1]});
}

std::string temperatures_toml(const ArrayDescription& array) {
  std::string text;
  if (array.temperature_gradient_celsius > 0.0) {
    text += fmt::format("temperature_gradient_celsius = {}\n", array.temperature_gradient_celsius);
  }
  if (array.temperature_sensors.empty()) return text;
  if (array.temperature_sensors == sensors_on_each_taxel(array.rows, array.cols)) {
    return text + fmt::format("temperature_sensors = \"{}\"\n", kEachTaxel);
  }
  std::vector<std::string> places;
  for (const auto& [row, col] : array.temperature_sensors) places.push_back(fmt::format("[{}, {}]", row, col));
  return text + fmt::format("temperature_sensors = [{}]\n", fmt::join(places, ", "));
}

/// Taxels in any order fill the array; `sent` is its own shape where it is left out.
void read_taxel_order(ConfigFile& file, const ArrayDescription& array, LineOrder& order) {
  file.counts("array.taxel_order", order.taxel_order);
  std::vector<std::size_t> sent;
  file.counts("array.sent", sent);
  if (order.taxel_order.empty()) {
    if (!sent.empty()) file.fail("array.sent", "has no meaning without taxel_order");
    return;
  }
  if (!sent.empty() && (sent.size() != 2 || sent[0] < 1 || sent[0] > kMaxLines || sent[1] < 1 || sent[1] > kMaxLines)) {
    return file.fail("array.sent", "must be rows and columns of 1 to 1024, as [4, 8]");
  }
  order.taxels_sent = sent.empty() ? order.sent({array.rows, array.cols}) : FrameShape{sent[0], sent[1]};
  order.taxel_rows = array.rows;
}

void read_order(ConfigFile& file, LineOrder& order) {
  file.count("array.skip_columns", order.skip_columns);
  file.boolean("array.transpose", order.transpose);
  file.boolean("array.flip_rows", order.flip_rows);
  file.boolean("array.flip_cols", order.flip_cols);
  file.counts("array.row_order", order.row_order);
  file.counts("array.col_order", order.col_order);
}

template <typename Choice>
void read_choice(ConfigFile& file, std::string_view key, std::initializer_list<Choice> choices, Choice& value) {
  std::vector<std::string> names;
  for (const Choice choice : choices) names.emplace_back(to_string(choice));
  auto index = static_cast<std::size_t>(std::find(choices.begin(), choices.end(), value) - choices.begin());
  file.choice(key, names, index);
  value = *(choices.begin() + index);
}

/// The circuits in which a key has a meaning. `none` may keep the keys that describe most arrays, and ignores them.
std::vector<Circuit> circuits_with(std::string_view key) {
  using enum Circuit;
  if (key == "readout.idle_rows") return {divider, transimpedance, none};
  if (key == "readout.idle_columns") return {divider};
  if (key == "readout.column_switch_ohm") return {transimpedance, flexitac, divider};
  if (key == "readout.row_segment_ohm" || key == "readout.column_segment_ohm")
    return {divider, transimpedance, flexitac};
  return {transimpedance};
}

bool has_key(std::string_view key, Circuit circuit) {
  const std::vector<Circuit> circuits = circuits_with(key);
  return std::find(circuits.begin(), circuits.end(), circuit) != circuits.end();
}

void refuse_keys_of_other_circuits(ConfigFile& file, Circuit circuit) {
  for (const char* const key :
       {"readout.idle_rows", "readout.idle_columns", "readout.column_switch_ohm", "readout.amplifier_offset_v",
        "readout.amplifier_gain", "readout.row_segment_ohm", "readout.column_segment_ohm"}) {
    if (has_key(key, circuit) || !file.contains(key)) continue;
    std::vector<std::string> owners;
    for (const Circuit owner : circuits_with(key)) {
      if (owner != Circuit::none) owners.push_back(fmt::format("\"{}\"", to_string(owner)));
    }
    file.fail(key, fmt::format("has no meaning with circuit = \"{}\", only with {}; remove it", to_string(circuit),
                               fmt::join(owners, " or ")));
  }
}

void read_resistors(ConfigFile& file, std::string_view key, Circuit circuit, std::size_t lines,
                    std::vector<double>& ohms) {
  if (circuit != Circuit::none && circuit != Circuit::automatic) file.require(key);
  // Which lines have drivers and which loads, and so how many there are of each, is not known before the circuit is.
  file.number_per_line(key, circuit == Circuit::automatic ? 1 : lines, {"fit", kFitOhm}, ohms);
  if (circuit == Circuit::none) ohms.clear();  // known or not, the resistances are not used
}

/// INPUT_PULLUP of an Arduino: a divider upside down. Its loads are in the chip, and its idle rows are inputs.
void read_pulled_up(ConfigFile& file, Readout& readout) {
  file.require("readout.adc_bits");
  readout.circuit = Circuit::divider;
  readout.idle_rows = IdleRows::floating;
  readout.pressure_raises_reading = false;
}

/// Besides the circuits, what readings are that have left theirs behind.
void read_circuit(ConfigFile& file, Readout& readout) {
  using enum Circuit;
  constexpr std::array kCircuits{divider, transimpedance, flexitac, none, automatic};
  std::vector<std::string> names;
  for (const Circuit circuit : kCircuits) names.emplace_back(to_string(circuit));
  names.insert(names.end(), {kPressure, kForce, kInputPullup});
  std::size_t index = 0;
  file.require("readout.circuit");
  file.choice("readout.circuit", names, index);
  if (index < kCircuits.size()) {
    readout.circuit = kCircuits[index];
    file.require("readout.adc_bits");
    return;
  }
  if (names[index] == kInputPullup) return read_pulled_up(file, readout);
  readout.circuit = none;
  readout.quantity = names[index] == kPressure ? Quantity::pressure : Quantity::force;
  readout.adc_bits = kMostAdcBits;
  file.require("readout.adc_noise_counts");
}

/// A number, or "fit".
void read_or_fit(ConfigFile& file, std::string_view key, std::optional<double>& value) {
  if (file.is_text(key, "fit")) {
    value = kFit;
  } else {
    file.number(key, value);
  }
}

/// Points of sent counts beside volts, or beside the counts of an ideal ADC where it measures against the supply.
void read_curve(ConfigFile& file, Readout& readout) {
  std::vector<std::vector<double>> points;
  file.number_rows("readout.adc_curve", 2, points);
  double volts_per_count = 1.0;
  if (readout.adc_reference_v) volts_per_count = *readout.adc_reference_v / readout.full_scale_counts();
  for (const std::vector<double>& point : points) {
    readout.adc_errors.curve.push_back({point[0], point[1] / volts_per_count});
  }
}

void read_adc_errors(ConfigFile& file, Readout& readout) {
  read_or_fit(file, "readout.adc_settling", readout.adc_errors.settling);
  read_or_fit(file, "readout.adc_offset_counts", readout.adc_errors.offset_counts);
  read_curve(file, readout);
}

void read_readout(ConfigFile& file, ArrayDescription& array) {
  Readout& readout = array.readout;
  read_circuit(file, readout);
  refuse_keys_of_other_circuits(file, readout.circuit);
  read_choice(file, "readout.idle_rows", {IdleRows::grounded, IdleRows::floating}, readout.idle_rows);
  read_choice(file, "readout.idle_columns", {IdleColumns::loaded, IdleColumns::floating}, readout.idle_columns);
  read_resistors(file, "readout.drive_ohm", readout.circuit, array.driven_lines(), readout.drive_ohm);
  read_resistors(file, "readout.load_ohm", readout.circuit, array.sensed_lines(), readout.load_ohm);
  file.number_per_line("readout.column_switch_ohm", array.sensed_lines(), readout.column_switch_ohm);
  file.number_per_line("readout.amplifier_offset_v", array.cols, readout.amplifier_offset_v);
  file.number("readout.amplifier_gain", readout.amplifier_gain);
  file.number_per_line("readout.row_segment_ohm", array.rows, readout.row_segment_ohm);
  file.number_per_line("readout.column_segment_ohm", array.cols, readout.column_segment_ohm);
  read_film(file, readout.film);
  file.integer("readout.adc_bits", readout.adc_bits);
  file.number("readout.adc_noise_counts", readout.adc_noise_counts);
  file.number_per_line("readout.drive_error_ohm", array.driven_lines(), readout.drive_error_ohm);
  file.number("readout.drive_error_correlation", readout.drive_error_correlation);
  file.number("readout.supply_noise", readout.supply_noise);
  if (!file.is_text("readout.adc_reference_v", "supply")) {
    file.number("readout.adc_reference_v", readout.adc_reference_v);
  }
  file.number("readout.supply_v", readout.supply_v);
  read_or_fit(file, "readout.supply_ohm", readout.supply_ohm);
  read_adc_errors(file, readout);
  file.boolean("readout.pressure_raises_reading", readout.pressure_raises_reading);
  if (file.is_text("readout.circuit", kInputPullup) && readout.pressure_raises_reading) {
    file.fail("readout.pressure_raises_reading", "is false with circuit = \"input_pullup\"");
  }
  file.number("readout.rail_counts", readout.rail_counts);
}

/// The messages of validate() begin with the key.
void fail_invalid(ConfigFile& file, const std::string& message) {
  const std::size_t colon = message.find(": ");
  file.fail(message.substr(0, colon), message.substr(colon + 2));
}

Result<ArrayDescription> read_array(ConfigFile& file) {
  ArrayDescription array;
  read_geometry(file, array);
  read_absent(file, array);
  read_cover(file, array.cover);
  read_temperatures(file, array);
  read_order(file, array.order);
  read_taxel_order(file, array, array.order);
  read_readout(file, array);
  file.ignore("layout");
  if (const Status read = file.finish(); !read) return read.error();
  if (const Status valid = array.validate(); !valid) fail_invalid(file, valid.error().message);
  if (const Status valid = file.finish(); !valid) return valid.error();
  return array;
}

std::string ohm_toml(double ohm) {
  return std::isnan(ohm) ? "\"fit\"" : fmt::format("{}", ohm);
}

/// A line "key = ..." for one value a line; nothing for an empty list.
std::string per_line_toml(std::string_view key, const std::vector<double>& values) {
  if (values.empty()) return {};
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(ohm_toml(value));
  const bool is_uniform = std::all_of(texts.begin(), texts.end(), [&](const auto& text) { return text == texts[0]; });
  return fmt::format("{} = {}\n", key, is_uniform ? texts[0] : fmt::format("[{}]", fmt::join(texts, ", ")));
}

std::vector<std::string> absent_names(const ArrayDescription& array) {
  std::vector<std::string> names;
  for (const std::size_t taxel : array.absent) names.push_back(quoted_toml(array.taxel_name(taxel)));
  return names;
}

/// A line for each key that is not as usual.
std::string order_toml(const LineOrder& order) {
  std::string text;
  if (order.skip_columns > 0) text += fmt::format("skip_columns = {}\n", order.skip_columns);
  if (order.transpose) text += "transpose = true\n";
  if (order.flip_rows) text += "flip_rows = true\n";
  if (order.flip_cols) text += "flip_cols = true\n";
  if (!order.row_order.empty()) text += fmt::format("row_order = [{}]\n", fmt::join(order.row_order, ", "));
  if (!order.col_order.empty()) text += fmt::format("col_order = [{}]\n", fmt::join(order.col_order, ", "));
  if (order.taxel_order.empty()) return text;
  return text + fmt::format("taxel_order = [{}]\nsent = [{}, {}]\n", fmt::join(order.taxel_order, ", "),
                            order.taxels_sent.rows, order.taxels_sent.cols);
}

std::string circuit_toml(const Readout& readout) {
  if (readout.quantity == Quantity::pressure) return fmt::format("circuit = \"{}\"\n", kPressure);
  if (readout.quantity == Quantity::force) return fmt::format("circuit = \"{}\"\n", kForce);
  std::string text = fmt::format("circuit = \"{}\"\n", to_string(readout.circuit));
  if (has_key("readout.idle_rows", readout.circuit)) {
    text += fmt::format("idle_rows = \"{}\"\n", to_string(readout.idle_rows));
  }
  if (has_key("readout.idle_columns", readout.circuit)) {
    text += fmt::format("idle_columns = \"{}\"\n", to_string(readout.idle_columns));
  }
  if (readout.circuit == Circuit::none) return text;
  text += per_line_toml("drive_ohm", readout.drive_ohm);
  text += per_line_toml("drive_error_ohm", readout.drive_error_ohm);
  if (readout.drive_error_correlation > 0.0) {
    text += fmt::format("drive_error_correlation = {}\n", readout.drive_error_correlation);
  }
  text += per_line_toml("load_ohm", readout.load_ohm);
  text += per_line_toml("column_switch_ohm", readout.column_switch_ohm);
  text += per_line_toml("amplifier_offset_v", readout.amplifier_offset_v);
  if (readout.amplifier_gain) text += fmt::format("amplifier_gain = {}\n", *readout.amplifier_gain);
  text += per_line_toml("row_segment_ohm", readout.row_segment_ohm);
  text += per_line_toml("column_segment_ohm", readout.column_segment_ohm);
  return text + film_toml(readout.film);
}

std::string fit_or_number_toml(std::string_view key, const std::optional<double>& value) {
  return value ? fmt::format("{} = {}\n", key, ohm_toml(*value)) : "";
}

std::string instrument_toml(const Readout& readout) {
  const AdcErrors& errors = readout.adc_errors;
  std::string text = fit_or_number_toml("supply_ohm", readout.supply_ohm) +
                     fit_or_number_toml("adc_settling", errors.settling) +
                     fit_or_number_toml("adc_offset_counts", errors.offset_counts);
  if (errors.curve.empty()) return text;
  const double volts_per_count = readout.adc_reference_v ? *readout.adc_reference_v / readout.full_scale_counts() : 1.0;
  std::vector<std::string> points;
  for (const AdcPoint& point : errors.curve) {
    points.push_back(fmt::format("[{}, {}]", point.sent_counts, point.ideal_counts * volts_per_count));
  }
  return text + fmt::format("adc_curve = [{}]\n", fmt::join(points, ", "));
}

}  // namespace

Result<ArrayDescription> read_array(const std::string& path) {
  Result<ConfigFile> file = ConfigFile::read(path);
  if (!file) return file.error();
  return read_array(*file);
}

Result<ArrayDescription> array_from_toml(std::string_view text, const std::string& name) {
  Result<ConfigFile> file = ConfigFile::parse(text, name);
  if (!file) return file.error();
  return read_array(*file);
}

std::string array_to_toml(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  std::string text = fmt::format("[array]\nname = {}\nrows = {}\ncols = {}\npitch_mm = [{:.15g}, {:.15g}]\n",
                                 quoted_toml(array.name), array.rows, array.cols,
                                 array.row_pitch_m * kMillimetresPerMetre, array.col_pitch_m * kMillimetresPerMetre);
  if (array.taxel_area_m2) {
    text += fmt::format("taxel_area_mm2 = {:.15g}\n", *array.taxel_area_m2 * kSquareMillimetresPerSquareMetre);
  }
  if (!array.absent.empty()) text += fmt::format("absent = [{}]\n", fmt::join(absent_names(array), ", "));
  text += cover_toml(array.cover);
  text += temperatures_toml(array);
  text += order_toml(array.order);
  text += "\n[readout]\n" + circuit_toml(readout);
  text += fmt::format("adc_bits = {}\nadc_noise_counts = {}\nsupply_noise = {}\nadc_reference_v = {}\n",
                      readout.adc_bits, readout.adc_noise_counts, readout.supply_noise,
                      readout.adc_reference_v ? fmt::format("{}", *readout.adc_reference_v) : "\"supply\"");
  if (readout.supply_v) text += fmt::format("supply_v = {}\n", *readout.supply_v);
  text += instrument_toml(readout);
  text += fmt::format("pressure_raises_reading = {}\n", readout.pressure_raises_reading);
  if (readout.rail_counts) text += fmt::format("rail_counts = {}\n", *readout.rail_counts);
  return text;
}

Status write_array(const std::string& path, const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write(array_to_toml(array));
  return file->commit();
}

}  // namespace dermis::bytes::files
