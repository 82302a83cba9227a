// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/touch/frames/axis.hpp"

namespace dermis::touch::compensation {

/// Whether unloaded taxels read at all. Most rows or columns keep silent together where the readout cuts small readings
/// off or was tared. So they do where something touched the array during its unloaded readings. Silence is no fault
/// there, nor soon after, when a light touch may look like unloaded taxels.
class UnloadedWitnesses {
 public:
  /// `silence`: evidence of this frame that a line is silent; 0 where nothing is expected to be read.
  void follow(const PerAxis<std::vector<float>>& silence) noexcept;

  /// Not long ago most rows or most columns were silent.
  [[nodiscard]] bool are_doubtful() const noexcept { return distrust_ > 0; }

 private:
  int distrust_ = 0;  // frames in which most have to read first
};

}  // namespace dermis::touch::compensation
