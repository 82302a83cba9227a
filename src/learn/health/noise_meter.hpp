// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <vector>

namespace dermis::learn::health {

/// Noise against the model's, from the differences of untouched taxels between frames, each in its own standard
/// deviations. The median of the frames counts, without the taxels that differ most.
class NoiseMeter {
 public:
  /// Deviations of the taxels from their unloaded conductance in standard deviations; NaN: touched, or held at 0 S.
  void add(const std::vector<double>& deviations);

  /// Standard deviation over that of the model; empty where something touches too much of the array all the time.
  [[nodiscard]] std::optional<double> ratio() const;

 private:
  [[nodiscard]] double rms_without_outliers() const;

  std::vector<double> last_;
  std::vector<double> differences_;
  std::vector<double> ratios_;
};

}  // namespace dermis::learn::health
