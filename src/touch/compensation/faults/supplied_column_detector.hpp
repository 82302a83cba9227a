// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/page_test.hpp"

namespace dermis::touch::compensation {

/// A column at the supply reads full scale in all rows, while most columns do not. Where loads can do that too, it has
/// to last while the loads elsewhere change. With `circuit = "none"` there is no supply on a column.
class SuppliedColumnDetector {
 public:
  explicit SuppliedColumnDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  struct Column {
    bool is_full_scale = false;  // in this frame
    double elsewhere = 0.0;      // readings of all other columns when it was last counted
    PageTest supplied;
    PageTest released;  // of a column that was found to be at the supply
  };

  [[nodiscard]] bool loads_have_changed(const Observation& seen, std::size_t col) noexcept;
  /// Finds the columns at full scale and returns how many.
  std::size_t find_full_scale(const Observation& seen, const FaultList& faults) noexcept;

  const ArrayDescription& array_;
  bool loads_reach_full_scale_;
  std::vector<Column> columns_;
};

}  // namespace dermis::touch::compensation
