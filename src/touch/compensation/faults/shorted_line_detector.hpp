// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "touch/compensation/faults/equal_presses.hpp"
#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/press_count.hpp"

namespace dermis::touch::compensation {

/// Two neighbouring lines are shorted when they read the same within the noise everywhere, pressed or not, and the
/// lines beside them differ. One press that shows both that they are equal and that the others are not may owe it to
/// its shape. Many of them, each released before the next, are a short. Where other lines show that taxels scatter, a
/// press is stronger evidence the more places it covers. Pairs under suspicion are compared in every frame, as are
/// those whose sums are alike. With `circuit = "none"` equal readings may have any reason, and lines without others
/// beside them have nothing to differ from.
class ShortedLineDetector {
 public:
  /// `equal_presses`: gets every press that is equal on two lines.
  ShortedLineDetector(const ArrayDescription& array, EqualPresses& equal_presses);

  void judge(const Observation& seen, FaultList& faults) noexcept;

  /// Adds the pairs with half the evidence that a fault needs; allocates.
  void suspect(const FaultList& faults, std::vector<LineFault>& suspicions) const;

 private:
  /// The state of a line and the next one.
  struct Pair {
    double ratio = 1.0;  // of their readings where they are shorted
    PressCount count{};
    EqualPresses learned{};                      // of them, until they are found to be shorted
    std::optional<std::size_t> learned_place{};  // where the press was last of which that was
  };

  /// Two taxels at one place of a line and the next one.
  struct PlaceComparison {
    bool is_judged = false;
    double largest = 0.0;     // of the two readings
    double deviation = 0.0;   // that noise makes of their difference
    double difference = 0.0;  // [deviations]
  };

  /// A line and the next one, in one frame.
  struct Comparison {
    bool different = false;                  // beyond the noise
    std::optional<std::size_t> equal_place;  // of the hardest press that is equal on both and on no line beside them
  };

  void judge_lines(const Observation& seen, Axis axis, FaultList& faults) noexcept;
  void judge_pair(const Observation& seen, Axis axis, std::size_t line, FaultList& faults) noexcept;
  [[nodiscard]] bool sums_are_alike(const Observation& seen, Axis axis, std::size_t line) const noexcept;
  [[nodiscard]] bool is_pressed(const Observation& seen, Axis axis, std::size_t line) const noexcept;
  [[nodiscard]] Comparison compare_with_next(const Observation& seen, Axis axis, std::size_t line,
                                             const FaultList& faults) const noexcept;
  [[nodiscard]] PlaceComparison compare_at(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                           const FaultList& faults) const noexcept;
  [[nodiscard]] PressComparison compare_beside(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                               const FaultList& faults) const noexcept;
  void learn(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
             const PressComparison& press) noexcept;
  [[nodiscard]] bool are_joined(const Observation& seen, Axis axis, std::size_t line, std::size_t a,
                                std::size_t b) const noexcept;
  void forget(Pair& pair) noexcept;
  [[nodiscard]] bool stands_out(const Observation& seen, Axis axis, std::size_t line, std::size_t place,
                                double deviation, const FaultList& faults) const noexcept;
  [[nodiscard]] bool are_alike(const Observation& seen, Axis axis, std::size_t line,
                               const FaultList& faults) const noexcept;

  const ArrayDescription& array_;
  EqualPresses& equal_presses_;
  PerAxis<std::vector<Pair>> pairs_;  // by their first lines
};

}  // namespace dermis::touch::compensation
