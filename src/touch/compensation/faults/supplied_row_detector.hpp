// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "touch/compensation/faults/equal_presses.hpp"
#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/press_count.hpp"

namespace dermis::touch::compensation {

/// A row at the supply reads the least in every column, as the others hold its reading too. The evidence is a press on
/// a part of it that shows in most other rows, equal within the noise. Presses on other rows must show on them alone:
/// where a whole column or everything is pressed, rows read alike without a fault. Where taxels are seen to scatter, no
/// load makes so many of them equal. One press then suffices, once all other rows have read more for 3 frames. With
/// `circuit = "none"` there is no supply on a row.
class SuppliedRowDetector {
 public:
  SuppliedRowDetector(const ArrayDescription& array, const EqualPresses& equal_presses);

  void judge(const Observation& seen, FaultList& faults) noexcept;

  /// Adds the row with half the evidence that a fault needs; allocates.
  void suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const;

 private:
  /// How the presses on a row show in the other rows.
  struct Comparison {
    std::optional<std::size_t> place;  // of a press that shows
    std::size_t alike = 0;             // readings of other rows that are equal to that press
    std::size_t closely_alike = 0;     // of these
    std::size_t all_alike = 0;         // closely, to all places that show
    double least = 0.0;                // readings of the row there
    double most = 0.0;
    int fails = 0;  // readings below those of the row
  };

  /// How a press on a row compares with the readings of the other rows in its column.
  struct ColumnComparison {
    bool shows = false;
    std::size_t alike = 0;
    std::size_t closely_alike = 0;
    int fails = 0;
  };

  void forget_presses() noexcept;
  void choose_candidate(const Observation& seen, const FaultList& faults) noexcept;
  void follow_rows_below(const Observation& seen, const FaultList& faults, double noise) noexcept;
  void judge_row(const Observation& seen, std::size_t row, bool is_known, FaultList& faults) noexcept;
  [[nodiscard]] double evidence_of_press(const Comparison& compared) const noexcept;
  [[nodiscard]] bool is_decisive(const Observation& seen, const Comparison& compared) const noexcept;
  [[nodiscard]] Comparison compare_row(const Observation& seen, std::size_t row,
                                       const FaultList& faults) const noexcept;
  [[nodiscard]] ColumnComparison compare_in_column(const Observation& seen, std::size_t row, std::size_t col,
                                                   const FaultList& faults) const noexcept;
  [[nodiscard]] bool is_ghost(const Observation& seen, std::size_t taxel) const noexcept;
  [[nodiscard]] bool another_row_is_pressed(const Observation& seen, std::size_t row,
                                            const FaultList& faults) const noexcept;

  const ArrayDescription& array_;
  const EqualPresses& equal_presses_;
  std::size_t candidate_ = 0;  // the row under suspicion
  PressCount count_;           // of its presses
  int decisive_frames_ = 0;
  int frames_below_ = 0;  // in a row, in which all other rows clearly read more
};

}  // namespace dermis::touch::compensation
