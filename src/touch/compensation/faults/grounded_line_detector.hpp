// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"

namespace dermis::touch::compensation {

/// Distinguishes silent lines that are shorted to 0 V from open ones. A pressed shorted line takes current from the
/// lines that cross it, and untouched taxels on those read less. It counts as pressed where its neighbours are. In the
/// same way it distinguishes dead taxels from ones that conduct but whose reading is stuck at 0.
class GroundedLineDetector {
 public:
  explicit GroundedLineDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  /// Sums over the untouched taxels of a line.
  struct Sums {
    double siemens = 0.0;
    double expected = 0.0;
    double variance = 0.0;
  };

  void find_untouched(const Observation& seen, const FaultList& faults) noexcept;
  void touch_around_presses(const Observation& seen) noexcept;
  void judge_line(const Observation& seen, LineFault& fault) const noexcept;
  void judge_taxel(const Observation& seen, LineFault& fault) const noexcept;
  [[nodiscard]] double siemens_between(const Observation& seen, std::size_t taxel) const noexcept;
  [[nodiscard]] double evidence_at(const Observation& seen, const LineFault& fault, std::size_t place) const noexcept;
  /// Evidence that a line of `axis` takes the current of a conductance at `place`; `is_solved`: the crosstalk was
  /// solved with it.
  [[nodiscard]] double evidence_of_current(const Observation& seen, Axis axis, std::size_t place, double siemens,
                                           bool is_solved) const noexcept;
  [[nodiscard]] double taken_share(const Observation& seen, Axis axis, std::size_t place,
                                   double pressed_siemens) const noexcept;
  [[nodiscard]] Sums sums_on(const Observation& seen, Axis axis, std::size_t line) const noexcept;

  const ArrayDescription& array_;
  std::vector<std::uint8_t> untouched_;  // [taxels]
  double common_share_ = 0.0;            // conductance over that of unloaded taxels, common to the array: temperature
};

}  // namespace dermis::touch::compensation
