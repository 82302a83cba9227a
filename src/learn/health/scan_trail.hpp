// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"

namespace dermis::learn::health {

/// Readings that keep a share of the one scanned before them. A press on the last taxel of a line then shows on the
/// first one of the next line, far from it. Within a line a trail cannot be told from the shape of a press.
class ScanTrail {
 public:
  /// `array` must outlive it. `lines`: those along which the scan goes, from the first to the last or `backwards`.
  ScanTrail(const ArrayDescription& array, Axis lines, bool backwards);

  /// As EqualLines::add().
  void add(std::span<const float> change, float strong);

  /// A sentence where there is such a trail.
  [[nodiscard]] std::optional<std::string> finding() const;

 private:
  /// Presses on the last taxel of a line.
  struct Turn {
    std::size_t frames = 0;
    std::size_t with_trail = 0;  // on the next line
    double share = 0.0;          // least of those: what the trail reads of the press
  };

  void add(std::size_t last, std::size_t next, std::span<const float> change, Turn& turn) const;

  const ArrayDescription* array_;
  Axis lines_;
  bool backwards_;
  std::vector<Turn> turns_;  // [lines]
};

}  // namespace dermis::learn::health
