// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/model_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace dermis::out::report {
namespace {

/// Order of the facts of a calibration; the rest follows.
constexpr std::array kOrder = {"labelled frames", "rejected frames", "loads",        "temperature", "supply",
                               "circuit",         "networks",        "memory",       "fit error",   "uncertainty",
                               "dead taxels",     "remarks",         "recalibration"};

/// "20 ohm", or "18 to 22 ohm" where the lines differ.
std::string resistances(const std::vector<double>& ohms) {
  const auto [low, high] = std::minmax_element(ohms.begin(), ohms.end());
  if (*low == *high) return fmt::format("{:.4g} ohm", *low);
  return fmt::format("{:.4g} to {:.4g} ohm", *low, *high);
}

std::string dead_taxels(const touch::pipeline::Model& model) {
  std::vector<std::string> names;
  for (std::size_t taxel = 0; taxel < model.networks.dead.size(); ++taxel) {
    if (model.networks.dead[taxel] != 0) names.push_back(model.array.taxel_name(taxel));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<Fact> array_facts(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  std::vector<Fact> facts = {
      {"name", array.name},
      {"taxels", fmt::format("{} rows x {} columns", array.rows, array.cols)},
      {"pitch", fmt::format("{:.4g} mm x {:.4g} mm", 1e3 * array.row_pitch_m, 1e3 * array.col_pitch_m)}};
  if (array.taxel_area_m2) {
    facts.emplace_back("pressed area of a taxel", fmt::format("{:.4g} mm\u00b2", 1e6 * *array.taxel_area_m2));
  }
  facts.emplace_back("circuit", to_string(readout.circuit));
  if (readout.circuit == Circuit::divider || readout.circuit == Circuit::transimpedance) {
    facts.emplace_back("idle rows", to_string(readout.idle_rows));
  }
  if (readout.circuit == Circuit::divider) facts.emplace_back("idle columns", to_string(readout.idle_columns));
  if (!readout.drive_ohm.empty()) facts.emplace_back("drive", resistances(readout.drive_ohm));
  if (!readout.load_ohm.empty()) facts.emplace_back("load", resistances(readout.load_ohm));
  if (!readout.row_segment_ohm.empty()) {
    facts.emplace_back("row lines, a taxel", resistances(readout.row_segment_ohm));
  }
  if (!readout.column_segment_ohm.empty()) {
    facts.emplace_back("column lines, a taxel", resistances(readout.column_segment_ohm));
  }
  facts.emplace_back("ADC", fmt::format("{} bit", readout.adc_bits));
  if (readout.supply_v) facts.emplace_back("nominal supply", fmt::format("{:.4g} V", *readout.supply_v));
  if (const std::size_t sensors = array.temperature_sensors.size(); sensors > 0) {
    facts.emplace_back("temperature sensors",
                       sensors == array.taxel_count() ? "one on each taxel" : fmt::format("{}", sensors));
  }
  return facts;
}

std::vector<Fact> calibration_facts(const touch::pipeline::Model& model) {
  if (model.provenance.empty()) return {{"calibration", "the model says of none"}};
  std::map<std::string, std::string> facts = model.provenance;
  facts["dead taxels"] = dead_taxels(model);
  facts.emplace("memory", "none was learned: creep and hysteresis stay in the forces");
  if (model.supply) facts["supply"] = fmt::format("{:.4g} to {:.4g} V", model.supply->least_v, model.supply->most_v);
  std::vector<Fact> ordered;
  for (const char* const name : kOrder) {
    if (const auto fact = facts.extract(name)) ordered.emplace_back(fact.key(), fact.mapped());
  }
  ordered.insert(ordered.end(), facts.begin(), facts.end());
  return ordered;
}

}  // namespace dermis::out::report
