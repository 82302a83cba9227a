// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/network/perceptron.hpp"

namespace dermis::support {

/// Consistent networks with random numbers in the range of a real calibration: about 1 mS at 10 N, some hidden units,
/// an unloaded conductance that drifts with temperature. Inputs: 2, or 3 with temperature.
inline touch::fusion::ForceNetworks random_networks(std::size_t taxels, std::size_t inputs, std::size_t hidden,
                                                    std::uint64_t seed) {
  Random random(seed);
  touch::fusion::ForceNetworks networks;
  networks.shape = {inputs, hidden, 2};
  networks.unloaded.temperature = {25.0, 20.0};
  networks.temperature_sigma_celsius = 0.3;
  networks.parameters.resize(networks.shape.parameter_count() * taxels);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const double reference = random.log_uniform(5e-4, 2e-3);
    const double share = random.uniform(3.0, 6.0);
    networks.unloaded.offset_siemens.push_back(random.uniform(1e-6, 2e-5));
    networks.unloaded.per_celsius.push_back(random.uniform(-1e-7, 1e-7));
    networks.reference_siemens.push_back(static_cast<float>(reference));
    networks.heaviest_siemens.push_back(static_cast<float>(reference * share));
    networks.heaviest_newtons.push_back(1e4F);  // beyond what the network gives: the clamp has its own tests
    networks.gain.push_back(static_cast<float>(random.uniform(0.5, 2.0)));
    networks.dead.push_back(0);
    for (std::size_t k = 0; k < networks.shape.parameter_count(); ++k) {
      const bool positive = touch::network::monotone::is_positive(networks.shape, k);
      const double value = positive ? random.log_uniform(0.05, 0.8) : 0.5 * random.normal();
      networks.parameters[k * taxels + taxel] = static_cast<float>(value);
    }
  }
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    networks.offset_sigma_siemens.push_back(static_cast<float>(random.log_uniform(1e-8, 1e-6)));
  }
  networks.relative_sigma.resize(touch::fusion::kSigmaKnots * taxels);
  for (float& sigma : networks.relative_sigma) sigma = static_cast<float>(random.log_uniform(1e-3, 1e-1));
  return networks;
}

/// The force of one taxel by the formula of the header, in double precision; `siemens` within the calibrated range,
/// `temperature_offset` in degrees from the centre and within the half span.
inline double reference_newtons(const touch::fusion::ForceNetworks& networks, std::size_t taxel, double siemens,
                                double temperature_offset) {
  const std::size_t taxels = networks.taxel_count();
  const auto heaviest = static_cast<double>(networks.heaviest_siemens[taxel]);
  const double excess =
      siemens - (networks.unloaded.offset_siemens[taxel] + networks.unloaded.per_celsius[taxel] * temperature_offset);
  if (excess <= 0.0) return 0.0;
  const double share = std::fmin(excess, heaviest) / static_cast<double>(networks.reference_siemens[taxel]);
  const double x[] = {std::log(share), share - 1.0,
                      temperature_offset / networks.unloaded.temperature.half_span_celsius};
  const touch::network::PerceptronShape& shape = networks.shape;
  const auto parameter = [&](std::size_t k) { return static_cast<double>(networks.parameters[k * taxels + taxel]); };
  double y = parameter(shape.output_bias());
  for (std::size_t i = 0; i < shape.inputs; ++i) y += parameter(shape.direct_weight(i)) * x[i];
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    double sum = parameter(shape.bias(unit));
    for (std::size_t i = 0; i < shape.inputs; ++i) sum += parameter(shape.weight(unit, i)) * x[i];
    y += parameter(shape.output_weight(unit)) / (1.0 + std::exp(-sum));
  }
  return static_cast<double>(networks.gain[taxel]) * std::exp(y);
}

}  // namespace dermis::support
