// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::health {

/// Inverts a readout circuit for its designer, each frame by itself and as exactly as numbers allow. Not thread-safe.
class CircuitInversion {
 public:
  /// `noise_ratio`: standard deviation of a reading over the supply, > 0. Fails where
  /// touch::compensation::make_crosstalk_inversion() does.
  [[nodiscard]] static Result<CircuitInversion> create(const ArrayDescription& array, double noise_ratio);

  /// `reading` [rows, cols]: over the supply, as the array gives it. False where no conductances give these readings.
  [[nodiscard]] bool invert(std::vector<double> reading);

  /// The conductances of the last frame [rows, cols] [S], and their standard deviations; NaN where it has no solution.
  [[nodiscard]] const std::vector<double>& siemens() const noexcept { return siemens_; }
  [[nodiscard]] const std::vector<double>& sigma_siemens() const noexcept { return sigma_siemens_; }

 private:
  CircuitInversion(const ArrayDescription& array, std::unique_ptr<touch::compensation::CrosstalkInversion> inversion,
                   double noise_ratio);

  std::unique_ptr<touch::compensation::CrosstalkInversion> inversion_;
  double noise_ratio_;
  bool falls_with_pressure_;
  std::vector<double> siemens_;
  std::vector<double> sigma_siemens_;
};

}  // namespace dermis::learn::health
