// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"

namespace dermis::touch::compensation {

/// A driver whose resistance is higher by d than the inversion assumes makes all conductances of its line come out too
/// small. The factor is 1 - d Y, where Y is the sum of the line as it comes out. So untouched taxels fall at once when
/// Y rises, and rise when it falls. Memory of the material acts otherwise: the trace of a press only fades. The
/// detector compares two frames of one line at a time, while there is no other fault.
class DriftingDriverDetector {
 public:
  explicit DriftingDriverDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  /// Weighted least squares of one unknown, with forgetting.
  struct Fit {
    double normal = 0.0;
    double moment = 0.0;
    double square = 0.0;
    double loads = 0.0;  // sum of the squared changes of the conductance of the line
    double pairs = 0.0;

    void add(double slope, double value, double variance, double load);
    [[nodiscard]] double estimate() const { return moment / normal; }
    [[nodiscard]] double deviation() const;
    [[nodiscard]] double typical_siemens() const;
  };

  struct Driver {
    Fit fallen;  // where the current of the line has fallen
    Fit risen;
    std::size_t first_frame = 0;
    Nanos first_time{};
  };

  /// The untouched taxels of a line, in two frames.
  struct Pair {
    double now = 0.0;
    double last = 0.0;
    double variance = 0.0;          // of the difference
    double unloaded_siemens = 0.0;  // of all taxels of the line
  };

  void compare_with_last(const Observation& seen, std::size_t line, FaultList& faults) noexcept;
  [[nodiscard]] Pair untouched_pair(const Observation& seen, std::size_t line) noexcept;
  void find_touched(const Observation& seen, std::size_t line) noexcept;
  void add_touched(const Observation& seen, std::size_t line) noexcept;
  void judge_driver(std::size_t line, FaultList& faults) noexcept;
  void remember(const Observation& seen) noexcept;

  const ArrayDescription& array_;
  std::vector<Driver> drivers_;           // [driven lines]
  std::vector<std::uint8_t> touched_;     // places of one line, with kContactReach more at either end
  std::vector<std::uint8_t> near_touch_;  // places of one line [sensed lines]
  bool has_last_ = false;
  std::vector<double> last_siemens_;       // [taxels]
  std::vector<double> last_line_siemens_;  // [driven lines]
};

}  // namespace dermis::touch::compensation
