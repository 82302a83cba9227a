// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {

/// Rate and jitter of the arrivals of the last 3 to 4 seconds.
class ArrivalMeter {
 public:
  void add(Nanos arrival) {
    if (!last_) block_begin_ = arrival;
    if (arrival - block_begin_ >= kBlock) begin_block(arrival);
    if (last_) {
      const double interval_s = std::chrono::duration<double>(arrival - *last_).count();
      Block& block = blocks_[current_];
      block.intervals += 1.0;
      block.sum += interval_s;
      block.sum_of_squares += interval_s * interval_s;
    }
    last_ = arrival;
  }

  [[nodiscard]] double rate_hz() const {
    const Block all = total();
    return all.sum > 0.0 ? all.intervals / all.sum : 0.0;
  }

  [[nodiscard]] Nanos jitter() const {
    const Block all = total();
    if (all.intervals < 2.0) return Nanos{};
    const double mean = all.sum / all.intervals;
    const double variance = std::max(0.0, all.sum_of_squares / all.intervals - mean * mean);
    return Nanos(std::llround(1e9 * std::sqrt(variance)));
  }

 private:
  struct Block {
    double intervals = 0.0;
    double sum = 0.0;  // [s]
    double sum_of_squares = 0.0;
  };

  void begin_block(Nanos arrival) {
    current_ = (current_ + 1) % blocks_.size();
    blocks_[current_] = {};
    block_begin_ = arrival;
  }

  [[nodiscard]] Block total() const {
    Block all;
    for (const Block& block : blocks_) {
      all.intervals += block.intervals;
      all.sum += block.sum;
      all.sum_of_squares += block.sum_of_squares;
    }
    return all;
  }

  static constexpr Nanos kBlock = std::chrono::seconds(1);
  std::array<Block, 4> blocks_{};
  std::size_t current_ = 0;
  Nanos block_begin_{};
  std::optional<Nanos> last_;
};

}  // namespace dermis
