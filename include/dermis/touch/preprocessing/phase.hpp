// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::preprocessing {

/// The present phase of the system. The paper: the Data Pre-Processing Unit is "determined by the current phase. Only
/// appropriate sensor data is transferred to the arithmetic processing unit".
enum class Phase {
  settle,     ///< The rubber and the electronics warm up: frames go nowhere.
  calibrate,  ///< Known loads are applied: labelled frames go to the sample database.
  operate,    ///< Every frame goes through the pipeline.
};

/// Where a frame goes.
enum class Destination { nowhere, sample_database, pipeline };

/// Settles for a time from the first frame on, then stays in `after_settling`, even if the clock goes back later. A
/// clock that goes back while settling restarts the time. Not thread-safe.
class PhaseSelector {
 public:
  /// `settle_time` >= 0; `after_settling` is calibrate or operate.
  PhaseSelector(Nanos settle_time, Phase after_settling) : settle_time_(settle_time), after_settling_(after_settling) {}

  /// The phase at `time`; the first call starts the clock.
  [[nodiscard]] Phase phase_at(Nanos time) noexcept;

  /// Where a frame of `time` goes; `labelled`: its loads are known.
  [[nodiscard]] Destination select(Nanos time, bool labelled) noexcept;

 private:
  Nanos settle_time_;
  Phase after_settling_;
  std::optional<Nanos> start_;
  bool settled_ = false;
};

}  // namespace dermis::touch::preprocessing
