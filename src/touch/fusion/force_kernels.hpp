// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

// The arithmetic of ForceFusion with the taxels in SIMD lanes (single precision, Highway). Taxels without a force are
// computed like all others; what comes out is never used.
namespace dermis::touch::fusion {

/// Conductance above the unloaded one, each [taxels] [S].
struct ExcessConductance {
  std::span<const float> reference_siemens;
  std::span<const float> per_reference_siemens;  ///< 1 / reference_siemens [1/S]
  std::span<const float> heaviest_siemens;
  std::span<const float> siemens;
  std::span<const float> sigma_siemens;
};

/// ln(|e| / reference) and |e| / reference - 1 in `inputs` [2, taxels], |e| clamped to the heaviest load: the law goes
/// on below zero. Where e = 0 the network is asked for one standard deviation, of which the detection limit is made.
void conductance_inputs(const ExcessConductance& excess, std::span<float> inputs) noexcept;

/// The inputs of forces and their standard deviations; each vector [taxels] where nothing else is said.
struct ForceSources {
  ExcessConductance excess;
  std::span<const float> log_gain;
  std::span<const float> inputs;              ///< Of the networks [inputs, taxels].
  std::span<const float> log_newtons;         ///< Their outputs.
  std::span<const float> gradient;            ///< d output / d input [inputs, taxels].
  std::span<const float> offset_per_celsius;  ///< [S/C]
  std::span<const float> offset_sigma;        ///< Part of excess.sigma_siemens that stays from frame to frame [S].
  std::span<const float> variance_rises;      ///< relative_sigma^2, of the first knot and from knot to knot
                                              ///< [kSigmaKnots, taxels]
  std::span<const float> table_variance;      ///< Relative, of the law that a table does not know.
  std::span<const float> temperature_sigma;   ///< [C]
  float temperature_per_celsius = 0.0F;       ///< Rise of the third input [1/C]; 0 where there is none.
  std::span<const float> gain_variance;       ///< Relative, of gains and of temperatures that were not calibrated.
  float log_first_knot = 0.0F;                ///< ln of the first knot of relative_sigma.
  float bend_below = 0.0F;                    ///< The first of end_bends.
  float knots_per_log = 0.0F;                 ///< Knots for a rise of ln(newtons) by one.
};

/// The results, each [taxels], by the formulas of ForceNetworks and ForceFusion.
struct FusedForces {
  std::span<float> newtons;
  std::span<float> sigma_newtons;
  std::span<float> noise_newtons;  ///< The part of sigma_newtons that comes from sigma_siemens.

  // ForceSums.
  std::span<float> signed_newtons;
  std::span<float> own_variance;
  std::span<float> newtons_per_siemens;
  std::span<float> newtons_per_celsius;
};

void forces(const ForceSources& sources, const FusedForces& fused) noexcept;

}  // namespace dermis::touch::fusion
