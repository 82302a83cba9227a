// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"

namespace dermis::learn::calibration {

/// Temperature of the sheet in a sample, from the centre [C], clamped to the span; 0 where temperature is not an input.
[[nodiscard]] double temperature_offset(const Sample& sample, const SampleTemperatures& temperatures);
/// The same of one taxel.
[[nodiscard]] double temperature_offset(const Sample& sample, std::size_t taxel,
                                        const SampleTemperatures& temperatures);

/// The same as an input of a network, in [-1, 1].
[[nodiscard]] double normalised_temperature(const Sample& sample, std::size_t taxel,
                                            const SampleTemperatures& temperatures);

/// Unloaded conductance of every taxel and the noise of one frame about it.
struct UnloadedFit {
  UnloadedLaw law;
  std::vector<double> offset_sigma_siemens;  ///< Standard error of the fit, averaged over its temperatures [taxels].
  std::vector<double> noise_siemens;  ///< Standard deviation of a single frame [taxels], at least a third of a count.
  std::vector<bool> is_stuck;         ///< Saturated although nothing presses, or without any reading [taxels].
};

/// By most of the frames in which nothing presses anywhere, at least one: some that are called so may be pressed.
[[nodiscard]] UnloadedFit fit_unloaded(const SampleDatabase& database, const SampleTemperatures& temperatures);

/// Conductance of a taxel above its unloaded value [S].
[[nodiscard]] inline double excess_siemens(const Sample& sample, std::size_t taxel, const UnloadedFit& unloaded,
                                           const SampleTemperatures& temperatures) {
  return unloaded.law.excess(taxel, sample.siemens[taxel], temperature_offset(sample, taxel, temperatures));
}

}  // namespace dermis::learn::calibration
