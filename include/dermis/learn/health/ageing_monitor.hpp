// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// Evidence of presses of unknown force on the age of a calibration.
struct AgeingEvidence {
  std::size_t comparisons = 0;        ///< Comparisons of four neighbouring taxels under one touch.
  std::size_t blocks = 0;             ///< Blocks of four taxels, compared as equals under touches from different sides.
  std::optional<double> gain_spread;  ///< Sd over the taxels of the logarithm of their gains since the calibration;
  double spread_sigma = 0.0;          ///< its standard deviation; empty: too few blocks.
  double calibrated_spread = 0.0;     ///< So much gains may differ by the calibration itself.

  /// The gains scatter by more than 5 % and by more than the calibration said, beyond three standard deviations.
  [[nodiscard]] bool has_aged() const noexcept;
};

/// "recalibrate: gains have changed by about 9 % from taxel to taxel (± 1 %, 214 comparisons under touches)" if it
/// has aged, otherwise what is known.
[[nodiscard]] std::string describe(const AgeingEvidence& evidence);

/// Compares taxels under the touches of every day. Four neighbours in a square carry
///
///   d = ln F(r, c) - ln F(r, c + 1) - ln F(r + 1, c) + ln F(r + 1, c + 1)
///
/// It is 0 for each pressure that is a product of functions of x and of y: a plane, an edge, a box, a bell. Other round
/// patches give d the sign of the quadrant around their centre in which the square lies. Gains g that have changed
/// since the calibration add the same d of ln g under every touch. So the product of two means of d counts, one of
/// touches whose centre lies diagonally one way and one of those the other way. Its mean over the squares is 4 times
/// the variance of ln g. Scatter from touch to touch is in no product, as the two means are of different touches.
///
/// Squares at the rim of a touch count little: there shapes differ most, and what they add hides gains. The weight is 1
/// / (1 + (c / 0.7)^4), where c is the difference of ln F between the taxels.
///
/// The comparison misses a gain that all taxels of the array, of a row or of a column share: that takes a known weight
/// (WeightCheck). Touches that all come to the same place are no evidence. A square remembers a weight of eight of each
/// way. Not thread-safe.
class AgeingMonitor {
 public:
  explicit AgeingMonitor(const touch::pipeline::Model& model);

  /// The next frame of the array. Allocates nothing.
  void add(const ForceFrame& force) noexcept;

  /// The evidence of the touches that are over.
  [[nodiscard]] AgeingEvidence evidence() const;

 private:
  /// Four taxels in a square.
  struct Block {
    std::array<float, 2> mean{};    // of d, by the way of the touches
    std::array<float, 2> weight{};  // of the touches in them
    std::uint8_t way = 0;           // of the present touch
    bool is_over = false;           // it lies another way now
    std::uint32_t frames = 0;       // of it; 0: there is none
    double sum = 0.0;               // of d in them, by their weights
    double sum_weight = 0.0;
  };

  void take_row(const ForceFrame& force, std::size_t row) noexcept;
  void compare_row(std::size_t row) noexcept;
  void compare(Block& block, std::size_t taxel) noexcept;
  void end_touch(Block& block) noexcept;

  std::size_t rows_;
  std::size_t cols_;
  double calibrated_spread_;
  std::vector<Block> blocks_;       // [rows - 1, cols - 1]
  std::vector<float> log_newtons_;  // NaN: not pressed [taxels]; as before in rows that are not pressed
  std::vector<bool> is_pressed_;    // a taxel of the row
  std::vector<bool> is_compared_;   // the row with the next one
  std::size_t comparisons_ = 0;
};

}  // namespace dermis::learn::health
