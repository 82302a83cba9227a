// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/learn/health/diagnosis.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::learn::health {

/// Examines an array by the frames of one stream, however it is touched. It reports line faults, noise and drift of the
/// unloaded taxels, saturation, temperature, misfit of the circuit and gains that have changed. It adds the findings of
/// a RawExamination. Keeps 8 bytes a frame. Not thread-safe.
class Examination {
 public:
  /// `model` must outlive the examination.
  explicit Examination(const touch::pipeline::Model& model);
  Examination(Examination&&) noexcept;
  Examination& operator=(Examination&&) noexcept;
  ~Examination();

  /// A frame that `pipeline`, made of the same model, has just processed. `force`: its result.
  void add(const RawFrame& raw, const ForceFrame& force, const touch::pipeline::Pipeline& pipeline);

  /// The diagnosis over all frames so far; `pipeline`: the one that processed them.
  [[nodiscard]] Diagnosis diagnosis(const touch::pipeline::Pipeline& pipeline) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::learn::health
