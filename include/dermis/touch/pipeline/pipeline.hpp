// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/fusion/material_memory.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/tare.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::touch::pipeline {

/// Unit 3 as the pipeline has it: what it estimates, and the film that it follows, are by the networks.
[[nodiscard]] Result<compensation::Compensator> make_compensator(const ArrayDescription& array,
                                                                 const fusion::ForceNetworks& networks);

class LiveNoise;
class TareJudge;

/// The paper's Fig. 4: counts in, newtons out. Not thread-safe: one per stream of frames.
class Pipeline {
 public:
  [[nodiscard]] static Result<Pipeline> create(const Model& model);
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  ~Pipeline();

  /// Never fails: what is wrong with a frame is in its status. Line faults are found from the frames, masked, and the
  /// rest is solved with them in the circuit. Allocates nothing after the first frame.
  void process(const RawFrame& raw, ForceFrame& force) noexcept;

  /// Intermediate stages of the last frame, for pictures and diagnosis.
  [[nodiscard]] const ConditionedFrame& conditioned() const noexcept { return conditioned_; }
  [[nodiscard]] const ConductanceFrame& conductance() const noexcept { return conductance_; }
  [[nodiscard]] preprocessing::Rejection rejection() const noexcept { return conditioner_.rejection(); }
  [[nodiscard]] std::string why_rejected() const { return conditioner_.why_rejected(); }
  [[nodiscard]] const preprocessing::SupplyBounds& supply_bounds() const noexcept {
    return conditioner_.supply_bounds();
  }
  [[nodiscard]] const compensation::LineFaultMonitor& line_faults() const noexcept { return monitor_; }

  /// Standard deviation of the readings over the calibrated one, 0 as long as too little is known. Where it is clearly
  /// more than 1, that of the forces grows with it.
  [[nodiscard]] double noise_growth() const noexcept;

  /// Zero is that of the calibration until the drift is followed (set_options) or tared.
  [[nodiscard]] compensation::OffsetDrift& drift() noexcept { return drift_; }

  /// Takes what the array shows over the next second as zero, as OffsetDrift::tare() does, where `over` allows it.
  void tare(TareOver over = TareOver::drift) noexcept;
  /// Back to the zero before the last tare.
  void undo_tare() noexcept;
  [[nodiscard]] const Tare& last_tare() const noexcept;

 private:
  Pipeline(const Model& model, compensation::Compensator compensator);

  preprocessing::Conditioner conditioner_;
  compensation::Compensator compensator_;
  compensation::LineFaultMonitor monitor_;
  compensation::OffsetDrift drift_;
  std::unique_ptr<LiveNoise> live_noise_;
  std::unique_ptr<TareJudge> tare_judge_;
  fusion::ForceFusion fusion_;
  std::optional<fusion::MaterialMemory> memory_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
};

}  // namespace dermis::touch::pipeline
