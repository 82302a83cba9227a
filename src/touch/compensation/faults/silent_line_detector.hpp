// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/page_test.hpp"
#include "touch/compensation/faults/silence_evidence.hpp"

namespace dermis::touch::compensation {

/// A line is silent when its taxels together read less than unloaded ones would. The evidence that each is silent is
/// summed over the line and the frames. The line has to read nothing but noise, while unloaded taxels elsewhere do
/// read.
///
/// One silent frame suffices where the line surely read within the second before: rubber does not fade so soon. A loose
/// contact is masked so while it is open, and reads again as soon as it surely does.
class SilentLineDetector {
 public:
  SilentLineDetector(const ArrayDescription& array, const UnloadedTaxels& unloaded, UnloadedWitnesses& witnesses);

  void judge(const Observation& seen, FaultList& faults) noexcept;

  /// Silence of the line would be noticed within 10 frames. False until the first frame.
  [[nodiscard]] bool sees(Axis axis, std::size_t line) const noexcept;

 private:
  struct LineTests {
    PageTest silent;
    PageTest alive;          // of a line that was found to be silent
    bool is_sudden = false;  // found so
  };

  [[nodiscard]] bool reads_again(LineTests& tests, const Observation& seen, Axis axis, std::size_t line) const noexcept;
  [[nodiscard]] bool is_noise(Axis axis, std::size_t line) const noexcept;
  void weigh_taxels(const Observation& seen) noexcept;
  void sum_over_lines(const FaultList& faults) noexcept;
  void judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept;
  [[nodiscard]] bool reads_noise_alone(const Observation& seen, Axis axis, std::size_t line,
                                       const FaultList& faults) const noexcept;

  const ArrayDescription& array_;
  const UnloadedTaxels& unloaded_;
  UnloadedWitnesses& witnesses_;  // gets every frame
  FloorEvidence floor_;
  double last_sigma_ratio_ = 0.0;
  double last_noise_growth_ = 1.0;
  std::size_t noise_frame_ = 0;                // when it began to grow
  std::vector<float> evidence_;                // that the taxel is silent, of this frame [taxels]
  PerAxis<std::vector<float>> line_evidence_;  // sums of it
  PerAxis<std::vector<Nanos>> read_;           // when the line surely read, the last time
  PerAxis<std::vector<LineTests>> tests_;
};

}  // namespace dermis::touch::compensation
