// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/direct_model.hpp"

#include <array>
#include <limits>

namespace dermis::touch::pipeline {
namespace {

constexpr double kPascalsPerKilopascal = 1000.0;
constexpr std::array<float, 2> kAnyForce{1e-12F, 1e12F};
constexpr float kNextToNothing = 1e-6F;  // as a relative error must be more than 0

double newtons_per_reading(const ArrayDescription& array) {
  if (array.readout.quantity != Quantity::pressure) return 1.0;
  return kPascalsPerKilopascal * array.taxel_area_m2.value_or(0.0);
}

}  // namespace

Model direct_model(const ArrayDescription& array) {
  Model model;
  model.array = array;
  const std::size_t taxels = array.taxel_count();
  fusion::ForceNetworks& networks = model.networks;
  networks.shape = {2, 0, 2};  // force = gain * conductance: ln(e) has the weight 1, all else 0
  networks.parameters.assign(networks.shape.parameter_count() * taxels, 0.0F);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    networks.parameters[networks.shape.direct_weight(0) * taxels + taxel] = 1.0F;
  }
  networks.gain.assign(taxels, static_cast<float>(newtons_per_reading(array) * array.readout.full_scale_counts()));
  networks.unloaded.offset_siemens.assign(taxels, 0.0);
  networks.unloaded.per_celsius.assign(taxels, 0.0);
  networks.reference_siemens.assign(taxels, 1.0F);
  networks.heaviest_siemens.assign(taxels, 1.0F);
  networks.heaviest_newtons.assign(taxels, std::numeric_limits<float>::infinity());
  networks.dead.assign(taxels, 0);
  networks.offset_sigma_siemens.assign(taxels, 0.0F);
  networks.relative_sigma.assign(fusion::kSigmaKnots * taxels, kNextToNothing);
  networks.sigma_knots_newtons = kAnyForce;  // no law ends
  return model;
}

}  // namespace dermis::touch::pipeline
