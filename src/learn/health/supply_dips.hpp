// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dermis::learn::health {

/// Finds frames of an untouched array in which all taxels conduct less by one factor than in the frames around them.
/// There the supply falls, and nothing in the frame says so. Loads and the material only add, and last longer.
class SupplyDips {
 public:
  explicit SupplyDips(std::size_t taxels) : mean_(taxels), frames_(taxels) {}

  /// Takes the conductance of an untouched taxel in the present frame, and its standard deviation.
  void add(std::size_t taxel, double siemens, double sigma_siemens);

  /// All untouched taxels of the frame were added. `is_untouched`: no other taxel was touched.
  void end_frame(bool is_untouched);

  /// "the supply falls by about 8 % in 23 of 412 untouched frames: ..."; empty: no sign of it.
  [[nodiscard]] std::optional<std::string> finding() const;

 private:
  static constexpr std::size_t kAround = 31;  // frames

  /// Sums over the taxels of a frame, x: mean of a taxel so far, y: conductance now.
  struct Sums {
    double count = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double variance = 0.0;
  };
  struct Level {
    double share = 0.0;  // of the mean
    double sigma = 0.0;
    double slope = 0.0;   // of y over x, as the share if all change by a factor; 1 if all lose the same
    double weight = 0.0;  // of the slope: over its variance
  };

  void judge_middle();

  std::vector<double> mean_;         // [taxels]
  std::vector<std::size_t> frames_;  // [taxels]
  Sums sums_;
  std::array<Level, kAround> around_{};
  std::size_t levels_ = 0;
  std::size_t dips_ = 0;
  std::size_t rises_ = 0;
  double depth_ = 0.0;  // sum over the dips
  double slope_ = 0.0;  // the same of what the slope falls, by its weight
  double weight_ = 0.0;
};

}  // namespace dermis::learn::health
