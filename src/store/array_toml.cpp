// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/store/array_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "dermis/core/config_table.hpp"
#include "dermis/store/atomic_file.hpp"

namespace dermis::store {
namespace {

constexpr double kMillimetresPerMetre = 1e3;
constexpr double kSquareMillimetresPerSquareMetre = 1e6;

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

template <typename Choice>
void read_choice(ConfigFile& file, std::string_view key, std::initializer_list<Choice> choices, Choice& value) {
  std::vector<std::string> names;
  for (const Choice choice : choices) names.emplace_back(to_string(choice));
  auto index = static_cast<std::size_t>(std::find(choices.begin(), choices.end(), value) - choices.begin());
  file.choice(key, names, index);
  value = *(choices.begin() + index);
}

void read_resistors(ConfigFile& file, std::string_view key, Circuit circuit, std::size_t lines,
                    std::vector<double>& ohms) {
  const bool is_fit = file.is_text(key, "fit");
  if (circuit == Circuit::none) {  // known or not, the resistances are not used
    std::vector<double> unused;
    if (!is_fit) file.number_per_line(key, lines, unused);
    return;
  }
  if (is_fit) file.fail(key, "\"fit\" is not available yet; give the resistance in ohm");
  file.require(key);
  file.number_per_line(key, lines, ohms);
}

void read_readout(ConfigFile& file, std::size_t rows, std::size_t cols, Readout& readout) {
  file.require("readout.circuit");
  read_choice(file, "readout.circuit", {Circuit::divider, Circuit::transimpedance, Circuit::none}, readout.circuit);
  read_choice(file, "readout.idle_rows", {IdleRows::grounded, IdleRows::floating}, readout.idle_rows);
  read_resistors(file, "readout.drive_ohm", readout.circuit, rows, readout.drive_ohm);
  read_resistors(file, "readout.load_ohm", readout.circuit, cols, readout.load_ohm);
  file.require("readout.adc_bits");
  file.integer("readout.adc_bits", readout.adc_bits);
  file.number("readout.adc_noise_counts", readout.adc_noise_counts);
  file.number("readout.supply_noise", readout.supply_noise);
  if (!file.is_text("readout.adc_reference_v", "supply")) {
    file.number("readout.adc_reference_v", readout.adc_reference_v);
  }
  file.number("readout.supply_v", readout.supply_v);
  file.boolean("readout.pressure_raises_reading", readout.pressure_raises_reading);
}

/// The messages of validate() begin with the key.
void fail_invalid(ConfigFile& file, const std::string& message) {
  const std::size_t colon = message.find(": ");
  file.fail(message.substr(0, colon), message.substr(colon + 2));
}

Result<ArrayDescription> read_array(ConfigFile& file) {
  ArrayDescription array;
  read_geometry(file, array);
  read_readout(file, array.rows, array.cols, array.readout);
  if (const Status read = file.finish(); !read) return read.error();
  if (const Status valid = array.validate(); !valid) fail_invalid(file, valid.error().message);
  if (const Status valid = file.finish(); !valid) return valid.error();
  return array;
}

std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted.append("\\").append(1, c);
    } else if (code < 0x20U || code == 0x7FU) {
      quoted += fmt::format("\\u{:04X}", code);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string resistors_toml(const std::vector<double>& ohms) {
  const bool is_uniform = std::all_of(ohms.begin(), ohms.end(), [&](double ohm) { return ohm == ohms.front(); });
  return is_uniform ? fmt::format("{}", ohms.front()) : fmt::format("[{}]", fmt::join(ohms, ", "));
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
  text += fmt::format("\n[readout]\ncircuit = \"{}\"\nidle_rows = \"{}\"\n", to_string(readout.circuit),
                      to_string(readout.idle_rows));
  if (readout.circuit != Circuit::none) {
    text += fmt::format("drive_ohm = {}\nload_ohm = {}\n", resistors_toml(readout.drive_ohm),
                        resistors_toml(readout.load_ohm));
  }
  text += fmt::format("adc_bits = {}\nadc_noise_counts = {}\nsupply_noise = {}\nadc_reference_v = {}\n",
                      readout.adc_bits, readout.adc_noise_counts, readout.supply_noise,
                      readout.adc_reference_v ? fmt::format("{}", *readout.adc_reference_v) : "\"supply\"");
  if (readout.supply_v) text += fmt::format("supply_v = {}\n", *readout.supply_v);
  text += fmt::format("pressure_raises_reading = {}\n", readout.pressure_raises_reading);
  return text;
}

Status write_array(const std::string& path, const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write(array_to_toml(array));
  return file->commit();
}

}  // namespace dermis::store
