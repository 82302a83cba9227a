// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/inverted_frame.hpp"

namespace dermis::calibration {

/// The pressed taxels of a frame, and their force in all.
struct Press {
  const CircuitFrame* frame = nullptr;
  std::vector<std::size_t> taxels;
  double newtons = 0.0;
};

/// Frames by what they press.
struct Presses {
  std::vector<Press> single;   ///< One taxel alone.
  std::vector<Press> several;  ///< Up to six taxels that were all pressed alone, too, and no lighter.
};

/// At most so many of each kind, evenly chosen. Presses on several taxels keep the single ones of their taxels first.
[[nodiscard]] Presses sort_presses(const CircuitFrames& frames, std::size_t most);

/// The frames of all presses: the single ones, then those of several.
[[nodiscard]] std::vector<const CircuitFrame*> frames_of(const Presses& presses);

/// The residuals of an instrument.
struct InstrumentMisfit {
  std::vector<double> totals;  ///< ln(total as the laws of single presses say / true) [several]
  std::vector<double> sigmas;  ///< Standard deviation of each, if the circuit is right.
  /// Excess conductance of the idle taxels in the row, then in the column, of a single press over untouched, beside the
  /// idle ones elsewhere. In standard deviations [2 single].
  std::vector<double> idle;
};

/// The taxels whose idle readings stand so far above 0 that they show what lowers them [taxels].
[[nodiscard]] std::vector<bool> readable_taxels(const Presses& presses, const InvertedFrames& inverted);

/// `inverted`: of frames_of(presses), all there. A press must not change what idle taxels conduct. Each taxel has a law
/// `ln F = a + b z + c z^2 + d z^3 + e z^4` of `z = ln(conductance above the unloaded one)`. All taxels share c, d and
/// e; temperature shifts the law. Empty: too few presses, conductances that follow no law, or `readable` taxels that
/// would conduct nothing.
[[nodiscard]] std::optional<InstrumentMisfit> misfit_of(const Presses& presses, const InvertedFrames& inverted,
                                                        std::size_t cols, const std::vector<bool>& readable);

}  // namespace dermis::calibration
