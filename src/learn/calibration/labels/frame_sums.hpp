// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {

/// A frame with all its taxels in one number: it rises with the load, whatever the circuit.
struct FrameSum {
  double ratio = 0.0;           ///< Sum over the taxels.
  double sigma = 0.0;           ///< Standard deviation of the sum, by the noise of the array's description.
  double newtons = 0.0;         ///< Force of all loads together; NaN: not labelled.
  double celsius = 0.0;         ///< NaN: not known.
  std::uint32_t frame = 0;      ///< Index in the recording.
  std::uint32_t strongest = 0;  ///< The taxel that rises most above its unloaded reading.

  [[nodiscard]] bool is_labelled() const noexcept { return !std::isnan(newtons); }
};

/// Median ratio of every taxel over some of the frames that are called unloaded; 0 where there are none. `newtons` as
/// newtons_of_frames() has them.
[[nodiscard]] std::vector<double> unloaded_levels(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                  std::span<const std::optional<double>> newtons);

/// The sums of all frames after settling that are not rejected.
[[nodiscard]] std::vector<FrameSum> sum_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                               std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::learn::calibration
