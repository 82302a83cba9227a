// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "compensation/faults/fault_list.hpp"
#include "compensation/faults/unloaded_taxels.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::compensation {

/// Whether the taxels that nothing presses read what unloaded ones do. Where most of them do not, the readout cuts
/// small readings off, or was tared, or something touched the array while its unloaded readings were taken: silence is
/// no fault there, nor soon after, when a light touch may look like unloaded taxels.
class UnloadedWitnesses {
 public:
  void follow(const ConditionedFrame& conditioned, const UnloadedTaxels& unloaded, const FaultList& faults) noexcept;

  /// Not long ago most of the array was unloaded and did not read.
  [[nodiscard]] bool are_doubtful() const noexcept { return distrust_ > 0; }

 private:
  int distrust_ = 0;  // frames in which they have to read first
};

}  // namespace dermis::compensation
