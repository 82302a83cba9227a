// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/fusion/material_memory.hpp"

namespace dermis::learn::calibration {

/// The memory of a material as a recording shows it.
struct LearnedMemory {
  touch::fusion::MemoryLaw law;
  SampleDatabase material;            ///< The same samples, with the share of their forces that the material shows,
  ForceTraining training;             ///< and what is trained on them.
  double error_without = 0.0;         ///< Mean relative errors on loads that the fits did not see, without the law
  double error_with = 0.0;            ///< and with it.
  double longest_hold_seconds = 0.0;  ///< So long the longest load lay still.
  double interval_seconds = 0.0;      ///< Between frames, the usual one.
  bool has_unloading = false;         ///< Loads got lighter without going.
};

/// "the material remembers: a load that lies still reads 12 % more after ten seconds than after one, ...", and what the
/// recording cannot tell.
[[nodiscard]] std::string describe(const LearnedMemory& memory);

/// The frames are so close in time that most loads are seen as they come, lie and go.
[[nodiscard]] bool is_continuous(std::span<const RawFrame> frames);

/// Labels name loads on the same taxels at least every 1.5 s: slower frames show memory, too. `frames`: the recording
/// of `database`, or empty.
[[nodiscard]] bool loads_follow_each_other(const SampleDatabase& database, std::span<const RawFrame> frames);

/// Learns the law of MaterialMemory from a continuous recording with labels. Networks give the felt force in every
/// frame, labelled or not. The law is the one that best frees these forces from their past where the load is known.
/// Then the networks are trained again on the felt forces of the loads. The result is kept only where the errors on
/// each half of the recording, unseen by networks and law, fall by 5 % or more. Empty also where there are too few
/// loads. `frames`: the recording of `database`; `plain`: what was trained on it.
[[nodiscard]] std::optional<LearnedMemory> learn_memory(const SampleDatabase& database,
                                                        std::span<const RawFrame> frames, const ForceTraining& plain);

}  // namespace dermis::learn::calibration
