// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// A line on stderr, below the status line where there is one. Work goes on when nobody reads the line: unlike
/// fmt::print(), it does not throw. Thread-safe.
void print_notice(const std::string& text);

/// The error of printing to the standard output.
[[nodiscard]] Error cannot_print(int error_number);

/// The line on stderr that redraws itself on a terminal. One at a time.
class StatusLine {
 public:
  StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  ~StatusLine();

  [[nodiscard]] bool is_terminal() const noexcept { return is_terminal_; }

  /// In place of what it showed; only on a terminal.
  void redraw(const std::string& text);

  /// Ends the line, so that something else can be said.
  void end();

 private:
  bool is_terminal_;
};

/// How far long work is and how long it still takes: a bar, or a plain line every quarter where there is no terminal.
class Progress {
 public:
  Progress() = default;
  /// `of`: whose work it is, such as the name of an array.
  explicit Progress(const std::string& of) : prefix_(of + ", ") {}

  /// `share` in [0, 1] of `stage`.
  void show(const std::string& stage, double share);

 private:
  StatusLine line_;
  std::string prefix_;
  std::string stage_;
  int last_shown_ = -1;
  std::chrono::steady_clock::time_point start_{};  // of the stage
};

/// How live work goes, or a plain line every 5 s where there is no terminal.
class LiveLine {
 public:
  void show(const std::string& text);
  void end() { line_.end(); }

 private:
  static constexpr std::chrono::seconds kPlainPeriod{5};
  StatusLine line_;
  std::chrono::steady_clock::time_point next_plain_ = std::chrono::steady_clock::now() + kPlainPeriod;
};

/// "1234 frames, 99.8/s ± 0.3 ms, 0 lost, 0 damaged, clock +12 ppm", and how often the device came back.
[[nodiscard]] std::string summary(std::uint64_t frames, const SourceStatistics& source);

}  // namespace dermis::app
