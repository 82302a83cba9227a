// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "status_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <mutex>

namespace dermis::app {
namespace {

std::mutex stderr_mutex;
bool line_is_open = false;

/// ", 12 s left"; empty while it is unknown, at the end, and below a second.
std::string time_left(std::chrono::steady_clock::time_point start, double share) {
  const double past_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double left_s = share > 0.0 ? past_s * (1.0 - share) / share : 0.0;
  return left_s < 1.0 ? "" : fmt::format(", {:.0f} s left", left_s);
}

void end_line() {
  if (line_is_open) std::fputs("\n", stderr);
  line_is_open = false;
}

}  // namespace

void print_notice(const std::string& text) {
  const std::lock_guard lock(stderr_mutex);
  end_line();
  std::fputs((text + "\n").c_str(), stderr);
}

Error cannot_print(int error_number) {
  return failed(fmt::format("cannot write the standard output: {}", std::strerror(error_number)));
}

StatusLine::StatusLine() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  end();
}

void StatusLine::redraw(const std::string& text) {
  const std::lock_guard lock(stderr_mutex);
  std::fputs(("\r" + text).c_str(), stderr);
  std::fflush(stderr);
  line_is_open = true;
}

void StatusLine::end() {
  const std::lock_guard lock(stderr_mutex);
  end_line();
}

void Progress::show(const std::string& stage, double share) {
  constexpr int kBarWidth = 40;
  constexpr int kTerminalSteps = 100;
  constexpr int kPlainSteps = 4;
  if (stage != stage_) {
    line_.end();
    stage_ = stage;
    start_ = std::chrono::steady_clock::now();
    last_shown_ = -1;
  }
  const int step = static_cast<int>(share * (line_.is_terminal() ? kTerminalSteps : kPlainSteps));
  if (step <= last_shown_) return;
  last_shown_ = step;
  const std::string left = time_left(start_, share);
  if (!line_.is_terminal())
    return print_notice(fmt::format("{}{}: {} %{}", prefix_, stage, step * 100 / kPlainSteps, left));
  const int filled = step * kBarWidth / kTerminalSteps;
  line_.redraw(fmt::format("{:<12} [{:#<{}}{:.<{}}] {:3} %{:<16}", prefix_ + stage, "", filled, "", kBarWidth - filled,
                           step, left));
}

void LiveLine::show(const std::string& text) {
  if (line_.is_terminal()) return line_.redraw(fmt::format("{:<79}", text));
  const auto now = std::chrono::steady_clock::now();
  if (now < next_plain_) return;
  next_plain_ = now + kPlainPeriod;
  print_notice(text);
}

std::string summary(std::uint64_t frames, const SourceStatistics& source) {
  std::string text = fmt::format("{} frames, {:.1f}/s", frames, source.rate_hz);
  const double jitter_ms = 1e3 * std::chrono::duration<double>(source.jitter).count();
  if (jitter_ms > 0.0) text += fmt::format(" \u00b1 {:.2g} ms", jitter_ms);
  text += fmt::format(", {} lost, {} damaged", source.lost_frames, source.damaged_frames);
  if (source.late_frames > 0) text += fmt::format(", {} late", source.late_frames);
  if (source.repeated_frames > 0) text += fmt::format(", {} repeated", source.repeated_frames);
  if (source.clock_drift_ppm) text += fmt::format(", clock {:+.0f} ppm", *source.clock_drift_ppm);
  if (source.reconnections > 0) text += fmt::format(", reconnected {} times", source.reconnections);
  return text;
}

}  // namespace dermis::app
