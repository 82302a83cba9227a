// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Log-likelihood ratio that decides. A false alarm in 1e5 frames of 1e3 lines and taxels would need odds of e^18. The
/// rest is a margin for effects that the circuit's description leaves out.
inline constexpr double kEvidence = 30.0;
inline constexpr int kLineFrames = 3;   // for or against a faulty line, at least
inline constexpr int kHealFrames = 10;  // for the end of a fault, at least

/// Page's cumulative sum: evidence for a change, back to 0 whenever there is more against it.
struct PageTest {
  double evidence = 0.0;
  int frames = 0;
  std::size_t first_frame = 0;
  Nanos first_time{};

  void restart() { *this = PageTest(); }
  void add(double log_ratio, std::size_t frame, Nanos time) {
    evidence += log_ratio;
    if (evidence <= 0.0) return restart();
    if (frames++ > 0) return;
    first_frame = frame;
    first_time = time;
  }
  [[nodiscard]] bool decides(int least_frames) const { return frames >= least_frames && evidence >= kEvidence; }
};

}  // namespace dermis::touch::compensation
