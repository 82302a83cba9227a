// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "learn/calibration/training/force_network.hpp"

namespace dermis::learn::calibration {

/// A known force on one taxel.
struct TaxelPoint {
  double excess_siemens = 0.0;  ///< > 0
  double noise_siemens = 0.0;   ///< Standard deviation of it.
  double temperature = 0.0;     ///< About [-1, 1]; 0 where temperature is not an input.
  double newtons = 0.0;         ///< What the material felt, > 0.
  double load_newtons = 0.0;    ///< What pressed, > 0.
  std::size_t sample = 0;       ///< Where it comes from in the database.
  std::size_t press = 0;        ///< Where its press begins there, and its touch: PressNumbers.
  std::size_t touch = 0;
};

/// The loads of the points.
[[nodiscard]] std::vector<double> rising_loads(std::span<const TaxelPoint> points);

/// Trains ln(newtons) of one taxel on its points by Levenberg-Marquardt, from several random starts. Every point counts
/// by its noise and a floor for what the temperature and supply meters add. Two different loads determine a power, no
/// more. `temperature` is the span of the inputs where they have one.
[[nodiscard]] ForceNetwork train_taxel(const touch::network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                                       const TemperatureSpan& temperature, std::uint64_t seed);

/// The same from one start: of the networks of other taxels that have this shape, the one that fits the points best.
/// Taxels of a sheet are alike, and their networks lie near each other. Empty: no network has this shape.
[[nodiscard]] std::optional<ForceNetwork> train_taxel_like(std::span<const ForceNetwork> others,
                                                           const touch::network::PerceptronShape& shape,
                                                           std::span<const TaxelPoint> points,
                                                           const TemperatureSpan& temperature);

}  // namespace dermis::learn::calibration
