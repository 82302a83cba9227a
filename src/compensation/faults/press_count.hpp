// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/core/frames.hpp"

namespace dermis::compensation {

inline constexpr double kPressedSigmas = 20.0;  // readings worth comparing
inline constexpr double kEqualSigmas = 3.0;
inline constexpr double kDifferentSigmas = 5.0;
inline constexpr double kEqualShare = 0.01;  // drivers and ADC channels are alike to this
inline constexpr double kNewPress = 0.2;     // change that makes a press another one

/// Presses that speak for a short, since the last one that spoke against it.
struct PressCount {
  int presses = 0;
  int against = 0;  // frames in a row
  std::size_t first_frame = 0;
  Nanos first_time{};

  void add(int new_presses, std::size_t frame, Nanos time) {
    if (presses == 0 && new_presses > 0) {
      first_frame = frame;
      first_time = time;
    }
    presses += new_presses;
  }
};

}  // namespace dermis::compensation
