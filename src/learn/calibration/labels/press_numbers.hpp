// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>

#include "dermis/learn/calibration/sample_database.hpp"

namespace dermis::learn::calibration {

/// Numbers the presses and the touches in one place. A press is samples in a row under the same load. In a touch
/// presses follow each other, as where a weight is put onto another: what one touch changes, all of them have in
/// common.
class PressNumbers {
 public:
  /// The first sample of each.
  struct Numbers {
    std::size_t press = 0;
    std::size_t touch = 0;
  };

  /// Numbers for sample `index` of the database; they rise from call to call.
  const Numbers& next(const Sample& sample, std::size_t index, double load_newtons) {
    const auto [least, most] = std::minmax(load_newtons, first_newtons_);
    const bool is_next = samples_ > 0 && index == last_ + 1;
    const double frames_between = static_cast<double>(sample.frame) - static_cast<double>(last_frame_);
    last_ = index;
    last_frame_ = sample.frame;
    if (is_next && most <= kSameForce * least) {
      ++samples_;
      return numbers_;
    }
    const bool touches_on = is_next && frames_between <= kShortChange * static_cast<double>(samples_);
    numbers_ = {index, touches_on ? numbers_.touch : index};
    first_newtons_ = load_newtons;
    samples_ = 1;
    return numbers_;
  }

  static constexpr double kSameForce = 1.03;

 private:
  static constexpr double kShortChange = 0.2;  // from load to load, of the time that the first lay still

  Numbers numbers_;
  std::size_t last_ = 0;
  std::size_t last_frame_ = 0;
  std::size_t samples_ = 0;  // of the press
  double first_newtons_ = 0.0;
};

}  // namespace dermis::learn::calibration
