// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <fmt/core.h>

#include <chrono>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// A duration given on the command line, 0 ... 1e9 s.
inline Result<Nanos> nanos_from_seconds(double seconds, const char* option) {
  if (!(seconds >= 0.0 && seconds <= 1e9)) return bad_input(fmt::format("{}: must be 0 to 1e9 seconds", option));
  return std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(seconds));
}

}  // namespace dermis::app
