// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/inverted_frame.hpp"

namespace dermis::calibration {

/// What one frame presses, and with how much in all.
struct Press {
  const CircuitFrame* frame = nullptr;
  std::vector<std::size_t> taxels;
  double newtons = 0.0;
};

/// Frames by what they press.
struct Presses {
  std::vector<Press> single;   ///< One taxel alone.
  std::vector<Press> several;  ///< Taxels that were all pressed alone, too.
};

/// Of each kind some, evenly chosen, where there are very many.
[[nodiscard]] Presses sort_presses(const CircuitFrames& frames);

/// The frames of all presses: the single ones, then those of several.
[[nodiscard]] std::vector<const CircuitFrame*> frames_of(const Presses& presses);

/// What presses on several taxels differ by from what single ones tell.
struct TotalMisfit {
  std::vector<double> differences;  ///< ln(total as the laws of single presses say / true) [several]
  std::vector<double> sigmas;       ///< Standard deviation of each, if the circuit is right.
  double scatter = 0.0;             ///< Of a single press about its law, relative.
};

/// `inverted`: of frames_of(presses), all there. Each taxel has a law ln F = a + b z + c z^2 + d z^3 + e z^4 of
/// z = ln(conductance above the unloaded one), with c, d and e of all taxels the same; temperature shifts it. Empty:
/// too few presses to tell, or conductances that follow no law.
[[nodiscard]] std::optional<TotalMisfit> misfit_of_totals(const Presses& presses, const InvertedFrames& inverted);

}  // namespace dermis::calibration
