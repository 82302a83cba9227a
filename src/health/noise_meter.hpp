// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <vector>

namespace dermis::health {

/// Noise against what the model says, from how much the taxels that nothing touches differ from one frame to the next,
/// each in its own standard deviations: in the median of the frames, without the taxels that differ most.
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

}  // namespace dermis::health
