// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "compensation/faults/fault_list.hpp"
#include "compensation/faults/observation.hpp"
#include "compensation/faults/press_count.hpp"
#include "dermis/core/axis.hpp"

namespace dermis::compensation {

/// Two lines next to each other are shorted when presses on them read the same on both and on no line beside them. All
/// pairs under suspicion are compared in every frame, and one of the others, by turns.
class ShortedLineDetector {
 public:
  explicit ShortedLineDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  /// Presses on a line and the next one: new ones in which both read the same and the lines beside them do not, and
  /// those in which they differ.
  struct Comparison {
    int equal = 0;
    int different = 0;
  };

  struct Lines {
    std::vector<PressCount> counts;  // [pairs], by their first lines
    std::vector<double> last_ratio;  // of the last press that was equal, on the first line [taxels]
    std::size_t turn = 0;
  };

  void judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept;
  void judge_pair(const Observation& seen, Axis axis, std::size_t line, FaultList& faults) noexcept;
  [[nodiscard]] Comparison compare_with_next(const Observation& seen, Axis axis, std::size_t line,
                                             const FaultList& faults) noexcept;

  const ArrayDescription& array_;
  PerAxis<Lines> lines_;
};

}  // namespace dermis::compensation
