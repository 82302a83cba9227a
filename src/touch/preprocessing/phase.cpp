// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/phase.hpp"

namespace dermis::touch::preprocessing {

Phase PhaseSelector::phase_at(Nanos time) noexcept {
  if (!start_ || time < *start_) start_ = time;
  settled_ = settled_ || time - *start_ >= settle_time_;
  return settled_ ? after_settling_ : Phase::settle;
}

Destination PhaseSelector::select(Nanos time, bool labelled) noexcept {
  switch (phase_at(time)) {
    case Phase::settle: return Destination::nowhere;
    case Phase::calibrate: return labelled ? Destination::sample_database : Destination::nowhere;
    case Phase::operate: return Destination::pipeline;
  }
  return Destination::nowhere;
}

}  // namespace dermis::touch::preprocessing
