// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: ForceFrame.*RawFrame|RawFrame.*ForceFrame
#include "dermis/touch/frames/frames.hpp"

namespace {

float total_newtons(const dermis::ForceFrame& force) {
  float total = 0.0F;
  for (const float newtons : force.newtons) total += newtons;
  return total;
}

}  // namespace

int main() {
#ifdef MISTAKE
  const dermis::RawFrame frame;
#else
  const dermis::ForceFrame frame;
#endif
  return static_cast<int>(total_newtons(frame));
}
