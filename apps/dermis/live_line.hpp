// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "dermis/core/frame_source.hpp"

namespace dermis::app {

/// A line on stderr, below the live line where there is one. That nobody reads it ends no work: unlike fmt::print(), it
/// does not throw. Thread-safe.
void say(const std::string& text);

/// How live work goes, on stderr: a line that redraws itself on a terminal, a plain line every 5 s otherwise. One at a
/// time.
class LiveLine {
 public:
  LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;
  ~LiveLine();

  void show(const std::string& text);

  /// Ends the line, so that something else can be said.
  void end();

 private:
  bool is_terminal_;
  std::chrono::steady_clock::time_point next_plain_;
};

/// "1234 frames, 99.8/s +- 0.3 ms, 0 lost, 0 damaged, clock +12 ppm", and how often the device came back.
[[nodiscard]] std::string summary(std::uint64_t frames, const SourceStatistics& source);

}  // namespace dermis::app
