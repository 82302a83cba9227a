// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "support/reference_array.hpp"

namespace dermis::support {

inline constexpr float kExponent = 0.9F;
inline constexpr float kTemperatureWeight = 0.2F;

/// A divider array whose material is known: F = 10 N (e / reference)^0.9 exp(0.2 (T - 25 C) / 20 C) with e the excess
/// over the unloaded conductance. The network that states it has no hidden unit. Every taxel has a reference of its
/// own.
inline touch::pipeline::Model hand_made_model(std::size_t rows, std::size_t cols) {
  touch::pipeline::Model model;
  model.array = reference_circuit(rows, cols);
  model.array.name = "hand made";
  model.array.readout.adc_bits = 24;
  Random random(rows * 1000 + cols);
  const std::size_t taxels = rows * cols;
  touch::fusion::ForceNetworks& networks = model.networks;
  networks.shape = {touch::fusion::kInputsWithTemperature, 0, 2};
  networks.unloaded.temperature = {25.0, 20.0};
  for (std::size_t k = 0; k < taxels; ++k) {
    networks.unloaded.offset_siemens.push_back(random.uniform(4e-6, 6e-6));
    networks.unloaded.per_celsius.push_back(random.uniform(-2e-8, 2e-8));
    networks.reference_siemens.push_back(static_cast<float>(random.uniform(0.8e-3, 1.2e-3)));
    networks.heaviest_siemens.push_back(6e-3F);
    networks.heaviest_newtons.push_back(std::numeric_limits<float>::infinity());
    networks.gain.push_back(1.0F);
    networks.dead.push_back(0);
    networks.offset_sigma_siemens.push_back(1e-7F);
  }
  networks.relative_sigma.assign(touch::fusion::kSigmaKnots * taxels, 0.005F);
  networks.parameters.assign(taxels, std::log(10.0F));                                // c
  networks.parameters.insert(networks.parameters.end(), taxels, kExponent);           // s of ln(e / reference)
  networks.parameters.insert(networks.parameters.end(), taxels, 0.0F);                // s of e / reference - 1
  networks.parameters.insert(networks.parameters.end(), taxels, kTemperatureWeight);  // s of temperature
  return model;
}

/// The conductance of a taxel under a force: the material law turned round.
inline double siemens_under(const touch::pipeline::Model& model, std::size_t taxel, double newtons, double celsius) {
  const touch::fusion::ForceNetworks& networks = model.networks;
  const TemperatureSpan& calibrated = networks.unloaded.temperature;
  const double offset = celsius - calibrated.centre_celsius;
  const double at_centre = newtons / 10.0 * std::exp(-kTemperatureWeight * offset / calibrated.half_span_celsius);
  return networks.unloaded.at(taxel, offset) +
         static_cast<double>(networks.reference_siemens[taxel]) * std::pow(at_centre, 1.0 / kExponent);
}

}  // namespace dermis::support
