// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/models/model_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/touch/pipeline/direct_model.hpp"

namespace dermis::bytes::models {
namespace {

using touch::pipeline::direct_model;
using touch::pipeline::Model;

using files::SafetensorsFile;
using files::TensorReader;
using touch::fusion::ForceNetworks;
using touch::fusion::LookUpTables;
using touch::preprocessing::SupplyRange;

constexpr const char* kFormatWithoutSigma = "dermis model 1";
constexpr const char* kEndBends = "networks.end_bends";
constexpr const char* kTemperatureGap = "networks.temperature_gap_celsius";
constexpr const char* kGainErrors = "gain_errors";
constexpr const char* kProvenancePrefix = "provenance.";
constexpr std::size_t kMaxBaselines = 16;

/// The tensors of the networks, of shape [taxels] each.
struct TaxelTensors {
  std::array<std::pair<const char*, std::vector<double> UnloadedLaw::*>, 2> unloaded{
      {{"networks.offset_siemens", &UnloadedLaw::offset_siemens},
       {"networks.offset_per_celsius", &UnloadedLaw::per_celsius}}};
  std::array<std::pair<const char*, std::vector<float> ForceNetworks::*>, 5> floats{
      {{"networks.reference_siemens", &ForceNetworks::reference_siemens},
       {"networks.heaviest_siemens", &ForceNetworks::heaviest_siemens},
       {"networks.heaviest_newtons", &ForceNetworks::heaviest_newtons},
       {"networks.gain", &ForceNetworks::gain},
       {"networks.offset_sigma_siemens", &ForceNetworks::offset_sigma_siemens}}};
};

const std::string& metadata(const SafetensorsFile& file, const std::string& key) {
  static const std::string kEmpty;
  const auto found = file.metadata.find(key);
  return found == file.metadata.end() ? kEmpty : found->second;
}

std::size_t metadata_count(const SafetensorsFile& file, const std::string& key) {
  std::size_t value = 0;
  return files::parse_number(metadata(file, key), value) ? value : 0;
}

/// Only where there are tables: files without one stay as they always were.
void put_tables(SafetensorsFile& file, const touch::fusion::ForceTables& tables) {
  const std::size_t count = tables.taxels.size();
  if (count == 0) return;
  file.metadata["tables"] = std::to_string(count);
  file.metadata["tables.knots"] = std::to_string(tables.knots);
  put_tensor<std::int64_t>(file, "tables.taxels", {count}, {tables.taxels.begin(), tables.taxels.end()});
  put_tensor(file, "tables.siemens", {count, tables.knots}, tables.siemens);
  put_tensor(file, "tables.newtons", {count, tables.knots}, tables.newtons);
  put_tensor(file, "tables.per_celsius", {count}, tables.per_celsius);
}

touch::fusion::ForceTables get_tables(const SafetensorsFile& file, TensorReader& reader) {
  touch::fusion::ForceTables tables;
  const std::size_t count = metadata_count(file, "tables");
  tables.knots = metadata_count(file, "tables.knots");
  std::vector<std::int64_t> taxels;
  reader.get("tables.taxels", {count}, taxels);
  for (const std::int64_t taxel : taxels) {
    constexpr auto kNoTaxel = std::numeric_limits<std::uint32_t>::max();
    tables.taxels.push_back(std::in_range<std::uint32_t>(taxel) ? static_cast<std::uint32_t>(taxel) : kNoTaxel);
  }
  reader.get("tables.siemens", {count, tables.knots}, tables.siemens);
  reader.get("tables.newtons", {count, tables.knots}, tables.newtons);
  reader.get("tables.per_celsius", {count}, tables.per_celsius);
  return tables;
}

/// Only where there are some: files without them stay as they always were.
void put_gain_errors(SafetensorsFile& file, const GainErrors& errors) {
  if (errors.sigma.empty()) return;
  file.metadata[kGainErrors] = "sigma";
  put_tensor(file, "gain_errors.sigma", {errors.sigma.size()}, errors.sigma);
  put_tensor<double>(file, "gain_errors.shares", {3}, {errors.sheet_share, errors.row_share, errors.column_share});
}

GainErrors get_gain_errors(std::size_t taxels, std::size_t cols, TensorReader& reader) {
  GainErrors errors;
  errors.cols = cols;
  std::vector<double> shares;
  reader.get("gain_errors.sigma", {taxels}, errors.sigma);
  reader.get("gain_errors.shares", {3}, shares);
  if (shares.size() != 3) return errors;
  errors.sheet_share = shares[0];
  errors.row_share = shares[1];
  errors.column_share = shares[2];
  return errors;
}

void put_networks(SafetensorsFile& file, const ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  file.metadata["networks.inputs"] = std::to_string(networks.shape.inputs);
  file.metadata["networks.hidden"] = std::to_string(networks.shape.hidden);
  put_tensor<double>(file, "networks.temperature_celsius", {3},
                     {networks.unloaded.temperature.centre_celsius, networks.unloaded.temperature.half_span_celsius,
                      networks.temperature_sigma_celsius});
  const auto& gap = networks.temperature_gap_celsius;
  if (gap[0] < gap[1]) {
    file.metadata[kTemperatureGap] = "yes";
    put_tensor<double>(file, kTemperatureGap, {2}, {gap.begin(), gap.end()});
  }
  const auto& bends = networks.end_bends;
  if (bends[0] > 0.0F || bends[1] > 0.0F) {
    file.metadata[kEndBends] = "yes";
    put_tensor<float>(file, kEndBends, {2}, {bends.begin(), bends.end()});
  }
  const TaxelTensors tensors;
  for (const auto& [name, member] : tensors.unloaded) put_tensor(file, name, {taxels}, networks.unloaded.*member);
  for (const auto& [name, member] : tensors.floats) put_tensor(file, name, {taxels}, networks.*member);
  put_tensor(file, "networks.dead", {taxels}, networks.dead);
  put_tensor(file, "networks.relative_sigma", {touch::fusion::kSigmaKnots, taxels}, networks.relative_sigma);
  put_tensor<float>(file, "networks.sigma_knots_newtons", {2},
                    {networks.sigma_knots_newtons.begin(), networks.sigma_knots_newtons.end()});
  put_tensor(file, "networks.parameters", {networks.shape.parameter_count(), taxels}, networks.parameters);
  put_tables(file, networks.tables);
  put_gain_errors(file, networks.gain_errors);
}

ForceNetworks get_networks(const SafetensorsFile& file, std::size_t taxels, TensorReader& reader) {
  ForceNetworks networks;
  networks.shape = {metadata_count(file, "networks.inputs"), metadata_count(file, "networks.hidden"), 2};
  std::vector<double> temperature;
  reader.get("networks.temperature_celsius", {3}, temperature);
  if (temperature.size() == 3) {
    networks.unloaded.temperature = {temperature[0], temperature[1]};
    networks.temperature_sigma_celsius = temperature[2];
  }
  if (file.metadata.contains(kTemperatureGap)) {
    std::vector<double> gap;
    reader.get(kTemperatureGap, {2}, gap);
    if (gap.size() == 2) networks.temperature_gap_celsius = {gap[0], gap[1]};
  }
  if (file.metadata.contains(kEndBends)) {
    std::vector<float> bends;
    reader.get(kEndBends, {2}, bends);
    if (bends.size() == 2) networks.end_bends = {bends[0], bends[1]};
  }
  const TaxelTensors tensors;
  for (const auto& [name, member] : tensors.unloaded) reader.get(name, {taxels}, networks.unloaded.*member);
  for (const auto& [name, member] : tensors.floats) reader.get(name, {taxels}, networks.*member);
  reader.get("networks.dead", {taxels}, networks.dead);
  reader.get("networks.relative_sigma", {touch::fusion::kSigmaKnots, taxels}, networks.relative_sigma);
  std::vector<float> knots;
  reader.get("networks.sigma_knots_newtons", {2}, knots);
  if (knots.size() == 2) networks.sigma_knots_newtons = {knots[0], knots[1]};
  reader.get("networks.parameters", {networks.shape.parameter_count(), taxels}, networks.parameters);
  if (file.metadata.contains("tables")) networks.tables = get_tables(file, reader);
  return networks;
}

std::string baseline_key(std::size_t index, const char* field) {
  return "baseline." + std::to_string(index) + "." + field;
}

void put_baseline(SafetensorsFile& file, std::size_t index, const LookUpTables& tables) {
  const std::size_t taxels = tables.taxel_count();
  file.metadata[baseline_key(index, "name")] = tables.name;
  file.metadata[baseline_key(index, "signal")] =
      tables.signal == touch::fusion::LookUpSignal::reading ? "reading" : "conductance";
  file.metadata[baseline_key(index, "knots")] = std::to_string(tables.knots);
  put_tensor<double>(file, baseline_key(index, "reference_celsius"), {1}, {tables.reference_celsius});
  put_tensor(file, baseline_key(index, "knot_signal"), {taxels, tables.knots}, tables.knot_signal);
  put_tensor(file, baseline_key(index, "knot_newtons"), {taxels, tables.knots}, tables.knot_newtons);
  put_tensor(file, baseline_key(index, "temperature_coefficient"), {taxels}, tables.temperature_coefficient);
}

LookUpTables get_baseline(const SafetensorsFile& file, std::size_t index, std::size_t taxels, TensorReader& reader) {
  LookUpTables tables;
  tables.name = metadata(file, baseline_key(index, "name"));
  tables.signal = metadata(file, baseline_key(index, "signal")) == "reading" ? touch::fusion::LookUpSignal::reading
                                                                             : touch::fusion::LookUpSignal::conductance;
  tables.knots = metadata_count(file, baseline_key(index, "knots"));
  std::vector<double> reference;
  reader.get(baseline_key(index, "reference_celsius"), {1}, reference);
  if (!reference.empty()) tables.reference_celsius = reference.front();
  reader.get(baseline_key(index, "knot_signal"), {taxels, tables.knots}, tables.knot_signal);
  reader.get(baseline_key(index, "knot_newtons"), {taxels, tables.knots}, tables.knot_newtons);
  reader.get(baseline_key(index, "temperature_coefficient"), {taxels}, tables.temperature_coefficient);
  return tables;
}

void put_strip(SafetensorsFile& file, const touch::contacts::StripTable& strip) {
  const std::size_t knots = strip.centre_m.size();
  file.metadata["strip.knots"] = std::to_string(knots);
  put_tensor(file, "strip.centre_m", {knots}, strip.centre_m);
  put_tensor(file, "strip.position_m", {knots}, strip.position_m);
  put_tensor<double>(file, "strip.sigma_m", {1}, {strip.sigma_m});
}

touch::contacts::StripTable get_strip(const SafetensorsFile& file, TensorReader& reader) {
  const std::size_t knots = metadata_count(file, "strip.knots");
  touch::contacts::StripTable strip;
  reader.get("strip.centre_m", {knots}, strip.centre_m);
  reader.get("strip.position_m", {knots}, strip.position_m);
  std::vector<double> sigma;
  reader.get("strip.sigma_m", {1}, sigma);
  if (!sigma.empty()) strip.sigma_m = sigma.front();
  return strip;
}

/// Only where there is one: files without it stay as they always were.
void put_memory(SafetensorsFile& file, const touch::fusion::MemoryLaw& law) {
  file.metadata["memory"] = "creep and hysteresis";
  put_tensor<float>(file, "memory.creep", {law.creep.size()}, {law.creep.begin(), law.creep.end()});
  put_tensor<float>(file, "memory.gap", {law.gap.size()}, {law.gap.begin(), law.gap.end()});
}

touch::fusion::MemoryLaw get_memory(TensorReader& reader) {
  touch::fusion::MemoryLaw law;
  std::vector<float> creep(law.creep.size());
  std::vector<float> gap(law.gap.size());
  reader.get("memory.creep", {law.creep.size()}, creep);
  reader.get("memory.gap", {law.gap.size()}, gap);
  std::copy(creep.begin(), creep.end(), law.creep.begin());
  std::copy(gap.begin(), gap.end(), law.gap.begin());
  return law;
}

/// Only where it is known: files without it stay as they always were.
void put_supply(SafetensorsFile& file, const SupplyRange& supply) {
  file.metadata["supply"] = "range";
  put_tensor<double>(file, "supply.range_v", {2}, {supply.least_v, supply.most_v});
}

SupplyRange get_supply(TensorReader& reader) {
  std::vector<double> range;
  reader.get("supply.range_v", {2}, range);
  return range.size() == 2 ? SupplyRange{range[0], range[1]} : SupplyRange{};
}

/// An array.toml is enough where readings are forces.
Result<Model> read_direct_model(const std::string& path) {
  const Result<ArrayDescription> array = files::read_array(path);
  if (!array) return array.error();
  if (array->readout.quantity != Quantity::counts) return direct_model(*array);
  return bad_input(path + ": describes an array, and is no model; a calibration makes one");
}

Result<SafetensorsFile> file_of(const Model& model, const std::string& name) {
  if (!touch::pipeline::is_consistent(model))
    return failed("cannot write '" + name + "': the model holds values out of range");
  SafetensorsFile file;
  file.metadata["format"] = kModelFormat.name;
  file.metadata["array"] = files::array_to_toml(model.array);
  for (const auto& [key, text] : model.provenance) file.metadata[kProvenancePrefix + key] = text;
  put_networks(file, model.networks);
  file.metadata["baselines"] = std::to_string(model.baselines.size());
  for (std::size_t index = 0; index < model.baselines.size(); ++index) {
    put_baseline(file, index, model.baselines[index]);
  }
  if (model.memory) put_memory(file, *model.memory);
  if (model.strip) put_strip(file, *model.strip);
  if (model.supply) put_supply(file, *model.supply);
  return file;
}

Status read_baselines(const SafetensorsFile& file, const std::string& path, TensorReader& reader, Model& model) {
  const std::size_t baselines = metadata_count(file, "baselines");
  if (metadata(file, "baselines") != std::to_string(baselines)) {
    return bad_input(path + ": does not say how many baselines it holds");
  }
  if (baselines > kMaxBaselines) {
    return bad_input(path + ": has " + std::to_string(baselines) + " baselines, at most " +
                     std::to_string(kMaxBaselines) + " can be read");
  }
  for (std::size_t index = 0; index < baselines; ++index) {
    model.baselines.push_back(get_baseline(file, index, model.array.taxel_count(), reader));
  }
  return Done{};
}

Result<Model> model_of(const Result<SafetensorsFile>& file, const std::string& path) {
  if (!file) return file.error();
  if (metadata(*file, "format") == kFormatWithoutSigma) {
    return bad_input(path + ": is of an older dermis that did not know how sure its forces are; calibrate again");
  }
  if (const Status right = files::check_format(*file, kModelFormat); !right) {
    return bad_input(path + ": " + right.error().message);
  }
  Model model;
  Result<ArrayDescription> array = files::array_from_toml(metadata(*file, "array"), path + ": array");
  if (!array) return array.error();
  model.array = std::move(*array);

  const std::size_t taxels = model.array.taxel_count();
  TensorReader reader(*file);
  model.networks = get_networks(*file, taxels, reader);
  if (file->metadata.contains(kGainErrors)) {
    model.networks.gain_errors = get_gain_errors(taxels, model.array.cols, reader);
  }
  if (const Status read = read_baselines(*file, path, reader, model); !read) return read.error();
  if (file->metadata.contains("memory")) model.memory = get_memory(reader);
  if (file->metadata.contains("strip.knots")) model.strip = get_strip(*file, reader);
  if (file->metadata.contains("supply")) model.supply = get_supply(reader);
  if (reader.first_error()) return bad_input(path + ": " + reader.first_error()->message);
  if (!touch::pipeline::is_consistent(model)) {
    return bad_input(path + ": holds values out of range; calibrate again");
  }
  const std::string prefix = kProvenancePrefix;
  for (const auto& [key, text] : file->metadata) {
    if (key.starts_with(prefix)) model.provenance[key.substr(prefix.size())] = text;
  }
  return model;
}

}  // namespace

Status write_model(const std::string& path, const Model& model) {
  const Result<SafetensorsFile> file = file_of(model, path);
  return file ? files::write_safetensors(path, *file) : Status(file.error());
}

Result<std::string> model_to_bytes(const Model& model) {
  const Result<SafetensorsFile> file = file_of(model, model.array.name);
  return file ? files::safetensors_to_bytes(*file, model.array.name) : Result<std::string>(file.error());
}

Result<Model> read_model(const std::string& path) {
  if (path.ends_with(".toml")) return read_direct_model(path);
  return model_of(files::read_safetensors(path), path);
}

Result<Model> model_from_bytes(std::string_view bytes, const std::string& name) {
  return model_of(files::safetensors_from_bytes(bytes, name), name);
}

}  // namespace dermis::bytes::models
