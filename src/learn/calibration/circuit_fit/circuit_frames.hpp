// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// A labelled frame as the fit of the circuit sees it.
struct CircuitFrame {
  std::vector<double> ratio;       ///< Reading / supply [taxels].
  double sigma_ratio = 0.0;        ///< Standard deviation of each, as repetitions show it.
  double described_sigma = 0.0;    ///< Described sigma of one reading; the readings were cut at 0 with it.
  std::vector<float> newtons;      ///< [taxels]: 0 idle, NaN unknown or beside a pressed taxel, which may touch it too.
  std::vector<TotalForce> totals;  ///< Over taxels that share it in an unknown way, none of them at the rail.
  double temperature = 0.0;        ///< In [-1, 1] over the recording; 0 where it is not an input.
  std::size_t averaged = 1;        ///< Frames in a row with the same loads, taken as one.
  std::size_t first_frame = 0;     ///< The first of these, in the recording.
  std::size_t last_frame = 0;
};

struct CircuitFrames {
  std::vector<CircuitFrame> frames;
  bool has_temperature = false;  ///< Every frame has one and they differ enough.
};

/// The largest reading, as a ratio of full scale; 0 where all are negative.
[[nodiscard]] double highest_ratio(const CircuitFrames& frames);

/// Some taxels are pressed and others are idle. The effect of a circuit looks like a law of the rubber in frames of
/// loads on the whole array.
[[nodiscard]] bool presses_part(const CircuitFrame& frame);

/// Errors: bad loads, no labelled frame that can be used.
[[nodiscard]] Result<CircuitFrames> circuit_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                   std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::learn::calibration
