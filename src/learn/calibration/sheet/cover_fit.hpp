// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// A cover as presses of single taxels tell it.
struct CoverFit {
  std::optional<Cover> cover;
  double error = 0.0;       ///< Relative, of all felt forces in common.
  bool is_guessed = false;  ///< By the corners alone, as the circuit is not known yet.
  std::string sentence;     ///< On the cover, or on the press that would tell; may be empty.
};

/// Standard deviation of the Gaussian with this share across the corner, over the one at the centre [m].
[[nodiscard]] double spread_by_corner(double share, const ArrayDescription& array);

/// A cover raises the taxels around a press, on both lines of it and across the corners, the less the farther they are.
/// No circuit of crossings does that. A taxel that a press raises feels the force under which it, pressed alone,
/// conducts as much. That force over the one on the cover is the share at this distance over that at the centre. Shares
/// are medians over all pairs of taxels, and 1 together. `array`: a circuit that is unknown, or in part, is guessed,
/// and the lines of a press then do not count.
[[nodiscard]] CoverFit fit_cover(const ArrayDescription& array, std::span<const RawFrame> frames,
                                 std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::learn::calibration
