// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compensation/faults/fault_list.hpp"
#include "compensation/faults/observation.hpp"
#include "compensation/faults/press_count.hpp"

namespace dermis::compensation {

/// A row at the supply reads the least in every column, as the others hold its reading too. What speaks for it is a
/// press on a part of it that shows in most other rows, equal within the noise, while presses on other rows show on
/// them alone: where a whole column or everything is pressed, rows read alike without a fault. With `circuit = "none"`
/// there is no supply on a row.
class SuppliedRowDetector {
 public:
  explicit SuppliedRowDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

  /// The row that half as much as it takes speaks for; allocates.
  void suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const;

 private:
  /// What the presses on a row show in the other rows.
  struct Comparison {
    std::optional<std::size_t> place;  // of a press that shows
    std::size_t alike = 0;             // readings of other rows that are equal to that press
    int fails = 0;                     // readings below those of the row
  };

  /// How a press on a row stands against the readings of the other rows in its column.
  struct ColumnComparison {
    bool shows = false;
    std::size_t alike = 0;
    int fails = 0;
  };

  void choose_candidate(const Observation& seen, const FaultList& faults) noexcept;
  void judge_row(const Observation& seen, std::size_t row, bool is_known, FaultList& faults) noexcept;
  void forget_presses() noexcept;
  [[nodiscard]] Comparison compare_row(const Observation& seen, std::size_t row,
                                       const FaultList& faults) const noexcept;
  [[nodiscard]] ColumnComparison compare_in_column(const Observation& seen, std::size_t row, std::size_t col,
                                                   const FaultList& faults) const noexcept;
  [[nodiscard]] bool another_row_is_pressed(const Observation& seen, std::size_t row,
                                            const FaultList& faults) const noexcept;

  const ArrayDescription& array_;
  std::size_t candidate_ = 0;  // the row under suspicion
  PressCount count_;           // of its presses
  std::size_t alike_ = 0;      // readings of other rows that were equal to them
};

}  // namespace dermis::compensation
