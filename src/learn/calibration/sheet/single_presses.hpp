// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// One taxel is labelled, and no other.
struct SinglePress {
  std::size_t taxel = 0;
  double newtons = 0.0;
  double temperature = 0.0;  ///< In [-1, 1] over the recording; 0 where it is not an input.
  std::vector<double> rise;  ///< Conductances above the unloaded ones [taxels] [S].
};

/// What presses of single taxels show of a sheet.
struct SinglePresses {
  std::vector<SinglePress> presses;  ///< By taxel, the heaviest first.
  std::vector<double> sigma;         ///< Of a rise in one frame [taxels] [S].
};

/// Unloaded conductances are those of frames in which nothing presses on the lines of a taxel and near it, by the
/// described circuit. Empty: too few frames for a word on the sheet, or a circuit that is not known. Saturated presses
/// are left out, and of very many presses those that are lighter.
[[nodiscard]] std::optional<SinglePresses> single_presses(const ArrayDescription& array,
                                                          std::span<const RawFrame> frames, std::span<const Load> loads,
                                                          Nanos settle_time);

}  // namespace dermis::learn::calibration
