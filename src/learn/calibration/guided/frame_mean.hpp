// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::calibration {

/// The mean of frames of one array that follow each other. Temperature and supply are averaged with the counts, so a
/// steady ratio is right under an unsteady supply.
class FrameMean {
 public:
  void clear();
  /// `ratio` is what the conditioner made of the frame.
  void add(const RawFrame& raw, std::span<const double> ratio);
  /// Takes the frames of `other` in, which came later.
  void add(const FrameMean& other);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t taxel_count() const noexcept { return ratio_.size(); }
  [[nodiscard]] Nanos begin() const noexcept { return begin_; }
  [[nodiscard]] double mean_ratio(std::size_t taxel) const noexcept {
    return ratio_[taxel] / static_cast<double>(count_);
  }
  /// Sum of the squares of the differences of successive ratios of a taxel, over count() - 1 of them.
  [[nodiscard]] double squared_steps(std::size_t taxel) const noexcept { return squared_steps_[taxel]; }

  /// Taken at the time of the last one. count() must not be 0.
  [[nodiscard]] RawFrame frame() const;

 private:
  void add_sensors(const RawFrame& raw);

  std::size_t count_ = 0;
  Nanos begin_{};
  Nanos end_{};
  std::vector<double> counts_;
  std::vector<double> ratio_;
  std::vector<double> last_ratio_;
  std::vector<double> squared_steps_;
  std::vector<double> sensors_;  // of temperature
  std::vector<std::size_t> sensor_readings_;
  double temperature_ = 0.0;
  double supply_ = 0.0;
  std::size_t temperatures_ = 0;
  std::size_t supplies_ = 0;
};

}  // namespace dermis::learn::calibration
