// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

#include "dermis/touch/pipeline/model.hpp"

// Models of every circuit as plain structs, for the program that is compiled for this machine and for WebAssembly.
namespace dermis::wasm {

inline constexpr std::size_t kLines = 16;

/// "grounded_rows", "floating_rows", "floating_lines", "virtual_ground", "flexitac" or "none"; empty: any other name.
inline std::optional<ArrayDescription> described_array(std::string_view circuit) {
  ArrayDescription array;
  array.rows = kLines;
  array.cols = kLines;
  array.readout.drive_ohm.assign(kLines, 20.0);
  array.readout.load_ohm.assign(kLines, 200.0);
  array.readout.supply_v = 5.0;
  if (circuit == "floating_rows") {
    array.readout.idle_rows = IdleRows::floating;
  } else if (circuit == "floating_lines") {
    array.readout.idle_rows = IdleRows::floating;
    array.readout.idle_columns = IdleColumns::floating;
  } else if (circuit == "virtual_ground") {
    array.readout.circuit = Circuit::transimpedance;
  } else if (circuit == "flexitac") {
    array.readout.circuit = Circuit::flexitac;
  } else if (circuit == "none") {
    array.readout.circuit = Circuit::none;
    array.readout.drive_ohm.clear();
    array.readout.load_ohm.clear();
  } else if (circuit != "grounded_rows") {
    return std::nullopt;
  }
  return array;
}

/// Networks with a hidden unit for each taxel, and a material with a memory.
inline touch::pipeline::Model model_of(const ArrayDescription& array) {
  constexpr double kUnloadedSiemens = 5e-6;
  constexpr float kReferenceSiemens = 1e-3F;
  constexpr float kHeaviestSiemens = 8e-3F;
  constexpr double kReadingsPerSiemens = 100.0;  // of an unknown circuit
  const double scale = array.readout.circuit == Circuit::none ? kReadingsPerSiemens : 1.0;
  const auto float_scale = static_cast<float>(scale);
  const std::size_t taxels = array.taxel_count();
  touch::pipeline::Model model;
  model.array = array;
  touch::fusion::ForceNetworks& networks = model.networks;
  networks.shape = {touch::fusion::kInputsWithTemperature, 1, 2};
  networks.unloaded.temperature = {25.0, 20.0};
  networks.unloaded.offset_siemens.assign(taxels, kUnloadedSiemens * scale);
  networks.unloaded.per_celsius.assign(taxels, 0.0);
  networks.reference_siemens.assign(taxels, kReferenceSiemens * float_scale);
  networks.heaviest_siemens.assign(taxels, kHeaviestSiemens * float_scale);
  networks.heaviest_newtons.assign(taxels, std::numeric_limits<float>::infinity());
  networks.gain.assign(taxels, 10.0F);
  networks.dead.assign(taxels, 0);
  networks.offset_sigma_siemens.assign(taxels, 1e-7F * float_scale);
  networks.relative_sigma.assign(touch::fusion::kSigmaKnots * taxels, 0.01F);
  networks.parameters.resize(networks.shape.parameter_count() * taxels);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto set = [&](std::size_t parameter, float value) {
      networks.parameters[parameter * taxels + taxel] = value;
    };
    const float own = 0.01F * static_cast<float>(taxel % 64);
    set(networks.shape.bias(0), -0.5F + own);
    set(networks.shape.weight(0, 0), 0.4F);
    set(networks.shape.weight(0, 2), 0.2F);
    set(networks.shape.output_weight(0), 0.3F + own);
    set(networks.shape.direct_weight(0), 0.9F);
    set(networks.shape.direct_weight(2), 0.1F);
  }
  model.memory = touch::fusion::MemoryLaw{{0.05F, 0.05F, 0.05F, 0.05F}, {0.02F, 0.02F, 0.02F}};
  return model;
}

}  // namespace dermis::wasm
