// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/unloaded_witnesses.hpp"

#include <algorithm>
#include <iterator>

namespace dermis::touch::compensation {
namespace {

constexpr int kFramesOfDistrust = 200;
constexpr float kClearEvidence = 1.0F;  // of one frame: e times as likely

}  // namespace

void UnloadedWitnesses::follow(const PerAxis<std::vector<float>>& silence) noexcept {
  bool most_silent = false;
  bool most_read = true;
  for (const Axis axis : kAxes) {
    const std::vector<float>& lines = silence[axis];
    const auto silent =
        std::count_if(lines.begin(), lines.end(), [](float evidence) { return evidence > kClearEvidence; });
    const auto reading = std::count_if(lines.begin(), lines.end(), [](float evidence) { return evidence < 0.0F; });
    most_silent = most_silent || 2 * silent > std::ssize(lines);
    most_read = most_read && reading > silent;
  }
  if (most_silent) {
    distrust_ = kFramesOfDistrust;
  } else if (most_read && distrust_ > 0) {
    --distrust_;
  }
}

}  // namespace dermis::touch::compensation
