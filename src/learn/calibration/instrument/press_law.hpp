// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/instrument/press_choice.hpp"

namespace dermis::learn::calibration {

/// The residuals of an instrument.
struct InstrumentMisfit {
  std::vector<double> totals;  ///< ln(total as the laws of single presses say / true) [several]
  /// Excess conductance of the idle taxels in the row, then in the column, of a single press over untouched, beside the
  /// idle ones elsewhere. In standard deviations of the noise [2 single].
  std::vector<double> idle;
  /// Standard deviations if the circuit is right, by the scatter of single presses and of idle taxels [totals, idle].
  std::vector<double> sigmas;
};

/// The taxels whose idle readings stand so far above 0 that they show what lowers them [taxels].
[[nodiscard]] std::vector<bool> readable_taxels(const Presses& presses, const InvertedFrames& inverted);

/// `inverted`: of frames_of(presses), all there. A press must not change what idle taxels conduct. Each taxel has a law
/// `ln F = a + b z + c z^2 + d z^3 + e z^4` of `z = ln(conductance above the unloaded one)`. All taxels share d and e,
/// and their b and c are alike; temperature shifts the law. Empty: too few presses, conductances that follow no law, or
/// `readable` taxels that would conduct nothing.
[[nodiscard]] std::optional<InstrumentMisfit> misfit_of(const Presses& presses, const InvertedFrames& inverted,
                                                        std::size_t cols, const std::vector<bool>& readable);

/// Scatter of InstrumentMisfit::idle, of rows and columns apart, 1 at least. Idle taxels move with more than the noise
/// of readings: with temperature, creep, and what lies beside them.
[[nodiscard]] std::vector<double> sigmas_of_idle(std::span<const double> idle);

}  // namespace dermis::learn::calibration
