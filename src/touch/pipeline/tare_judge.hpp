// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/pipeline/tare.hpp"

namespace dermis::touch::pipeline {

/// Judges what a tare has taken as zero, in newtons. Not thread-safe.
class TareJudge {
 public:
  explicit TareJudge(const UnloadedLaw& unloaded);

  void begin(TareOver over) noexcept;

  /// The tare has ended with this step, at the temperature of `conductance`; one that may not be taken is undone.
  /// Allocates nothing. `scratch`: forces, of which nothing is kept.
  void end(compensation::OffsetDrift& drift, const ConductanceFrame& conductance, fusion::ForceFusion& fusion,
           ForceFrame& scratch) noexcept;

  void undo(compensation::OffsetDrift& drift) noexcept;

  [[nodiscard]] const Tare& tare() const noexcept { return tare_; }

 private:
  void press(const compensation::TareStep& step, const ConductanceFrame& conductance) noexcept;
  double take_load(const ForceFrame& force, const compensation::TareStep& step, bool beyond_drift) noexcept;

  UnloadedLaw unloaded_;
  TareOver over_ = TareOver::drift;
  Tare tare_;
  ConductanceFrame pressed_;  // unloaded but for the step
};

}  // namespace dermis::touch::pipeline
