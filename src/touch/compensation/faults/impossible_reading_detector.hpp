// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/page_test.hpp"
#include "touch/compensation/possible_readings.hpp"

namespace dermis::touch::compensation {

/// Finds readings that Compensator takes out of a frame, after ten frames or more. One above what the circuit can give
/// is impossible. One that only a taxel of a few ohm gives is a shorted crossing, or stuck where it never changes. At
/// virtual ground a shorted crossing is a saturated taxel on a row that otherwise reads nothing. Where lines have
/// resistance, presses can look like that, too.
///
/// Where idle rows are grounded, a taxel that reads T leaves the others of its column 1 - T of what they read. A high
/// reading beside which most of the column reads as unloaded is impossible, too; that takes twenty frames. At most
/// twelve readings are named at once: more are a fault of a line, or of the array.
class ImpossibleReadingDetector {
 public:
  explicit ImpossibleReadingDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  struct Watched {
    std::size_t taxel = 0;
    double last_sigmas = 0.0;
    int frames = 0;
    int repetitions = 0;
    PageTest impossible;
    PageTest shorted;
    PageTest released;
  };

  void watch_new(const Observation& seen, const FaultList& faults) noexcept;
  void watch(std::size_t taxel, const FaultList& faults) noexcept;
  [[nodiscard]] ReadingVerdict verdict(const Observation& seen, std::size_t taxel) const noexcept;
  [[nodiscard]] bool any_is_suspicious(std::span<const TaxelStatus> before,
                                       std::span<const TaxelStatus> after) const noexcept;
  void doubt_taken(std::span<const TaxelStatus> before, std::span<const TaxelStatus> after) noexcept;
  void watch_columns(const Observation& seen, const FaultList& faults) noexcept;
  [[nodiscard]] ReadingVerdict verdict_of_column(const Observation& seen, std::size_t taxel) const noexcept;
  [[nodiscard]] bool others_are_unloaded(const Observation& seen, std::size_t col) const noexcept;
  [[nodiscard]] bool row_is_silent(const Observation& seen, std::size_t taxel) const noexcept;
  void find(const Observation& seen, ReadingVerdict verdict, Watched& watched, FaultList& faults) const noexcept;
  [[nodiscard]] double evidence_of_impossible(const Observation& seen, ReadingVerdict verdict,
                                              std::size_t taxel) const noexcept;
  void heal(const Observation& seen, ReadingVerdict verdict, LineFaultKind kind, Watched& watched,
            FaultList& faults) const noexcept;

  const ArrayDescription& array_;
  PossibleReadings possible_;
  bool columns_tell_;
  bool rows_tell_;
  std::vector<ReadingVerdict> verdicts_;  // of this frame [taxels]
  bool any_verdict_ = false;              // some may be other than possible
  std::vector<Watched> watched_;
};

}  // namespace dermis::touch::compensation
