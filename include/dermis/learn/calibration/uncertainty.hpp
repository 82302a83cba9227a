// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <optional>
#include <string>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// Noise of one reading [counts], rounding included. It comes from the differences of successive unloaded samples, each
/// with the resolution of its own supply. So neither the level of a taxel nor its drift counts. Touched samples and
/// flickering taxels are left out. It is at least 1 / sqrt(12), the noise of rounding alone. More than half of the
/// taxels may be at an end of the ADC in more than a tenth of the samples. The cut-off part is then part of the
/// likelihood. Empty if there are fewer than 5 unloaded samples, or if that finds less than two counts: rounding hides
/// the rest. Thread-safe.
[[nodiscard]] std::optional<double> measure_adc_noise(const SampleDatabase& database);

/// Noise of the temperature sensor [C], from second differences of successive samples. 0 if samples have no
/// temperature, are fewer than 20, or differ by more than 1 C from one to the next. It is then part of the relative
/// error of the networks. Thread-safe.
[[nodiscard]] double measure_temperature_noise(const SampleDatabase& database);

/// At the knots of touch::fusion::ForceNetworks::relative_sigma.
using RelativeSigma = std::array<double, touch::fusion::kSigmaKnots>;

/// How sure the forces of a calibration are.
struct UncertaintyReport {
  std::optional<double> adc_noise_counts;  ///< Empty: it could not be measured, and the array's stays.
  double temperature_sigma_celsius = 0.0;
  double supply_noise = 0.0;                                 ///< Relative.
  std::optional<RelativeSigma> relative_sigma;               ///< For taxels with a network of their own.
  std::optional<RelativeSigma> relative_sigma_of_shared;     ///< Of taxels on the shared network.
  std::optional<RelativeSigma> relative_sigma_of_tables;     ///< Of taxels with a look-up table.
  std::optional<RelativeSigma> relative_sigma_of_unpressed;  ///< For such taxels that no load pressed.
  std::size_t unpressed_taxels = 0;                          ///< How many these are.
  double unexplained_share = 0.0;  ///< SampleDatabase::unexplained_share, beside all of these.
};

/// "readings ± 1.05 counts, supply ± 0.10 %, temperature ± 0.30 C, forces ± 0.2 to 0.4 % beside that".
[[nodiscard]] std::string describe(const UncertaintyReport& report, const ArrayDescription& array);

/// Fills in the uncertainty of `model`, in its array's readout and in its networks. The noise of the ADC and of the
/// temperature sensor is measured. The error of the supply and the relative error of the networks (misfit, hysteresis,
/// creep, noise of the material) are fitted together. They make the errors on tested loads likeliest. The relative
/// error is then scaled until 68.3 % of these errors are within one standard deviation and 95.4 % within two. Longer
/// tails may allow no such scale. Then too many are within one by the same factor as too few are within two. Tables
/// under loads that were not repeated are uncertain by 5 %. ForceFusion adds their uncertainty below the lightest load.
/// `model` holds the array and the networks of `training`. Errors: those of Compensator::create().
[[nodiscard]] Result<UncertaintyReport> fit_uncertainty(const SampleDatabase& database, const ForceTraining& training,
                                                        touch::pipeline::Model& model);

}  // namespace dermis::learn::calibration
