// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace dermis::learn::health {

/// How far the unloaded taxels have moved from their calibration.
class OffsetMeter {
 public:
  explicit OffsetMeter(std::size_t taxels) : share_(taxels), frames_(taxels) {}

  /// Takes the conductance of an untouched taxel over its calibrated unloaded one.
  void add(std::size_t taxel, double share) {
    share_[taxel] += share;
    ++frames_[taxel];
  }

  /// Median over the taxels, relative; empty where none was unloaded long enough.
  [[nodiscard]] std::optional<double> drift() const;

  /// Half of the range of the middle 68 % of the taxels, relative; empty of fewer than ten.
  [[nodiscard]] std::optional<double> spread() const;

 private:
  [[nodiscard]] std::vector<double> drifts() const;

  std::vector<double> share_;        // sum over the frames [taxels]
  std::vector<std::size_t> frames_;  // [taxels]
};

}  // namespace dermis::learn::health
