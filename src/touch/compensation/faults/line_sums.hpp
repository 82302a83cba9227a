// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Sums of one frame over the lines.
class LineSums {
 public:
  explicit LineSums(const ArrayDescription& array);

  void sum(const ConditionedFrame& conditioned, const ConductanceFrame& conductance, bool solved) noexcept;

  /// Readings on every line.
  [[nodiscard]] std::span<const double> ratio(Axis axis) const noexcept { return ratio_[axis]; }

  /// Conductances on every driven line; 0 where the crosstalk was not solved.
  [[nodiscard]] std::span<const double> driven_siemens() const noexcept { return driven_siemens_; }

 private:
  void sum_readings(std::span<const double> ratio) noexcept;
  void sum_conductances(std::span<const double> siemens) noexcept;

  const ArrayDescription& array_;
  PerAxis<std::vector<double>> ratio_;
  std::vector<double> driven_siemens_;
};

}  // namespace dermis::touch::compensation
