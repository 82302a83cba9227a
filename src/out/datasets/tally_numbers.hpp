// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <string>

#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

[[nodiscard]] inline double seconds_of(Nanos time) {
  return std::chrono::duration<double>(time).count();
}

/// Frames a second while episodes last.
[[nodiscard]] inline double rate_of(const ArrayTally& array) {
  return array.time > Nanos{} ? static_cast<double>(array.frames - array.episodes) / seconds_of(array.time) : 0.0;
}

[[nodiscard]] inline double mean_age_s(const ArrayTally& array) {
  return array.steps > 0 ? seconds_of(array.age) / static_cast<double>(array.steps) : 0.0;
}

[[nodiscard]] inline const char* unit_of(const ArrayTally& array) {
  return array.has_forces ? "N" : "counts";
}

/// "r3c4, r3c5 always, r0c1 at times"; "none"
[[nodiscard]] std::string faulty_text(const ArrayTally& array);

}  // namespace dermis::out::datasets
