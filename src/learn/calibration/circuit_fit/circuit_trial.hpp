// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/common_ratio.hpp"
#include "learn/calibration/circuit_fit/judge_frames.hpp"

namespace dermis::learn::calibration {

/// A circuit, and its fit to the frames.
struct CircuitTrial {
  std::string name;                       ///< "divider, idle rows floating"
  ArrayDescription array;                 ///< Unknown resistances are kFitOhm.
  const CircuitFrames* frames = nullptr;  ///< Those of the array's ADC.
  std::optional<CommonRatio> fit = {};    ///< Empty: it cannot give them, or is not resolved.
  double noise_share = 0.0;               ///< 0: it is resolved.
  bool is_rough = false;                  ///< The differences between its lines could not be compared.
  JudgedReadings readings = {};
  FrameMisfit misfit = {std::numeric_limits<double>::infinity()};  ///< Of the readings that tell.

  [[nodiscard]] bool is_unresolved() const { return noise_share > 0.0; }
};

/// One of each kind. Keeps the resistances that `array` gives for all drivers, or for all loads.
[[nodiscard]] std::vector<CircuitTrial> trials_of_all_kinds(const ArrayDescription& array, const CircuitFrames& frames);

/// `array` with readings that are taken as proportional to conductance.
[[nodiscard]] ArrayDescription without_circuit(const ArrayDescription& array);

/// Fits `most` frames with one resistance for all drivers and one for all loads, and judges all by the same scatter.
void fit_trials(std::size_t most, std::vector<CircuitTrial>& trials);

/// The same; circuits with nearly the same residual are fitted again with a resistance for each line.
void fit_trials_and_lines(std::size_t most, std::vector<CircuitTrial>& trials);

/// The residuals of two circuits over the readings that depend on both.
struct TrialComparison {
  FrameMisfit first;
  FrameMisfit second;
};
[[nodiscard]] TrialComparison compare(const CircuitTrial& first, const CircuitTrial& second);

/// The sum of squares by which a circuit must be better to be distinguished from another. Readings that no circuit
/// explains to their noise count for less.
[[nodiscard]] double sure_square(const FrameMisfit& best);

[[nodiscard]] bool has_less(const CircuitTrial& a, const CircuitTrial& b);

/// The odds are a thousand to one, or far better with lines whose differences could not be compared.
[[nodiscard]] bool is_surely_less(const CircuitTrial& better, const CircuitTrial& worse);

/// Judges by a few frames, which leave the laws nearly free: they may explain as many readings as they have terms.
[[nodiscard]] bool is_refuted(const CircuitTrial& worse, const CircuitTrial& better);

}  // namespace dermis::learn::calibration
