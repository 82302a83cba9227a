// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/typical_siemens.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::touch::fusion {
namespace {

/// Plain power laws: F = 10 N (e / reference)^0.9 times a gain of 1, 2 and 4.
ForceNetworks power_laws() {
  ForceNetworks networks;
  networks.shape = {2, 0, 2};
  networks.unloaded.temperature.centre_celsius = 20.0;
  networks.unloaded.temperature.half_span_celsius = 10.0;
  networks.heaviest_newtons.assign(3, std::numeric_limits<float>::infinity());
  networks.gain = {1.0F, 2.0F, 4.0F};
  networks.dead.assign(3, 0);
  networks.unloaded.offset_siemens.assign(3, 1e-5);
  networks.unloaded.per_celsius.assign(3, 0.0);
  networks.reference_siemens.assign(3, 1e-3F);
  networks.heaviest_siemens.assign(3, 1.0F);
  networks.offset_sigma_siemens.assign(3, 0.0F);
  networks.relative_sigma.assign(3 * kSigmaKnots, 0.01F);
  for (const float value : {std::log(10.0F), 0.9F, 0.0F})
    networks.parameters.insert(networks.parameters.end(), 3, value);
  return networks;
}

/// Excess under the median force of 20 N.
double closed_form(double gain) {
  return 1e-3 * std::pow(2.0 / gain, 1.0 / 0.9);
}

TEST(TypicalSiemens, is_the_inverse_of_the_networks_at_the_median_force) {
  const std::vector<double> siemens = typical_siemens(power_laws());
  ASSERT_EQ(siemens.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR((siemens[k] - 1e-5) / closed_form(std::exp2(k)), 1.0, 1e-4) << k;
  }
}

TEST(TypicalSiemens, of_a_dead_taxel_is_that_of_the_others) {
  ForceNetworks networks = power_laws();
  networks.gain = {1.0F, 1.0F, 1.0F};
  networks.dead = {0, 1, 0};
  const std::vector<double> siemens = typical_siemens(networks);
  EXPECT_NEAR(siemens[1] / siemens[0], 1.0, 1e-9);
  EXPECT_NEAR((siemens[0] - 1e-5) / 1e-3, 1.0, 1e-4);
}

TEST(TypicalSiemens, is_one_where_all_taxels_are_dead) {
  ForceNetworks networks = power_laws();
  networks.dead.assign(3, 1);
  EXPECT_EQ(typical_siemens(networks), std::vector<double>(3, 1.0));
}

}  // namespace
}  // namespace dermis::touch::fusion
