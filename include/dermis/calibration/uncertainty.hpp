// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <optional>
#include <string>

#include "dermis/calibration/force_training.hpp"
#include "dermis/calibration/sample_database.hpp"
#include "dermis/pipeline/model.hpp"

namespace dermis::calibration {

/// Noise of one reading [counts], rounding included: from the differences of successive unloaded samples, each against
/// the resolution of its own supply, so that neither the level of a taxel nor its drift counts. Samples that something
/// touched and taxels that flicker are left out. At least 1 / sqrt(12), what rounding alone does. Empty where there are
/// fewer than 5 unloaded samples, or where an end of the ADC hides the noise: more than half of the taxels stand at it
/// in more than a tenth of the samples. Thread-safe.
[[nodiscard]] std::optional<double> measure_adc_noise(const SampleDatabase& database);

/// Noise of the temperature sensor [C], from second differences of successive samples. 0 where samples carry no
/// temperature, are fewer than 20, or differ by more than 1 C from one to the next: then it is part of the relative
/// error of the networks. Thread-safe.
[[nodiscard]] double measure_temperature_noise(const SampleDatabase& database);

/// At the knots of fusion::ForceNetworks::relative_sigma.
using RelativeSigma = std::array<double, fusion::kSigmaKnots>;

/// How sure the forces of a calibration are.
struct UncertaintyReport {
  std::optional<double> adc_noise_counts;  ///< Empty: it could not be measured, and the array's stays.
  double temperature_sigma_celsius = 0.0;
  double supply_noise = 0.0;                                 ///< Relative.
  std::optional<RelativeSigma> relative_sigma;               ///< Of taxels with a network of their own.
  std::optional<RelativeSigma> relative_sigma_of_shared;     ///< Of taxels on the shared network.
  std::optional<RelativeSigma> relative_sigma_of_tables;     ///< Of taxels with a look-up table.
  std::optional<RelativeSigma> relative_sigma_of_unpressed;  ///< Of those of them that no load pressed.
};

/// "readings +- 1.05 counts, supply +- 0.10 %, temperature +- 0.30 C, forces +- 0.2 to 0.4 % beside that".
[[nodiscard]] std::string describe(const UncertaintyReport& report, const ArrayDescription& array);

/// Fills in what `model` is still to know of its own uncertainty, in its array's readout and in its networks. The noise
/// of the ADC and the temperature sensor is measured; the error of the supply and the relative error of the networks
/// (misfit, hysteresis, creep, noise of the material) are those which together make the errors on tested loads
/// likeliest, the latter scaled so that of them 68.3 % are within one standard deviation and 95.4 % within two; where
/// longer tails allow no such scale, too many are within one by the same factor as too few are within two. Tables under
/// loads that were not repeated are uncertain by 5 %; what they do not know below their lightest load is ForceFusion's.
/// `model` holds the array and the networks of `training`. Errors: those of Compensator::create().
[[nodiscard]] Result<UncertaintyReport> fit_uncertainty(const SampleDatabase& database, const ForceTraining& training,
                                                        pipeline::Model& model);

}  // namespace dermis::calibration
