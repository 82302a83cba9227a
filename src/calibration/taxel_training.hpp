// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>

#include "calibration/force_network.hpp"

namespace dermis::calibration {

/// A known force on one taxel.
struct TaxelPoint {
  double excess_siemens = 0.0;  ///< > 0
  double temperature = 0.0;     ///< About [-1, 1]; 0 where temperature is not an input.
  double newtons = 0.0;         ///< > 0
  std::size_t sample = 0;       ///< Where it comes from in the database.
};

/// Trains ln(newtons) of one taxel on its points by Levenberg-Marquardt. Every point counts by its noise:
/// `noise_siemens` of the reading plus a floor for what the temperature and supply meters add.
[[nodiscard]] ForceNetwork train_taxel(const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                                       double noise_siemens, std::uint64_t seed);

}  // namespace dermis::calibration
