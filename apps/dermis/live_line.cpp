// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace dermis::app {
namespace {

constexpr std::chrono::seconds kPlainPeriod{5};

std::mutex stderr_mutex;
bool line_is_open = false;

void end_line() {
  if (line_is_open) std::fputs("\n", stderr);
  line_is_open = false;
}

}  // namespace

void say(const std::string& text) {
  const std::lock_guard lock(stderr_mutex);
  end_line();
  std::fputs((text + "\n").c_str(), stderr);
}

LiveLine::LiveLine()
    : is_terminal_(isatty(STDERR_FILENO) == 1), next_plain_(std::chrono::steady_clock::now() + kPlainPeriod) {}

LiveLine::~LiveLine() {
  end();
}

void LiveLine::show(const std::string& text) {
  if (is_terminal_) {
    const std::lock_guard lock(stderr_mutex);
    std::fputs(fmt::format("\r{:<79}", text).c_str(), stderr);
    std::fflush(stderr);
    line_is_open = true;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now < next_plain_) return;
  next_plain_ = now + kPlainPeriod;
  say(text);
}

void LiveLine::end() {
  const std::lock_guard lock(stderr_mutex);
  end_line();
}

std::string summary(std::uint64_t frames, const SourceStatistics& source) {
  std::string text = fmt::format("{} frames, {:.1f}/s", frames, source.rate_hz);
  const double jitter_ms = 1e3 * std::chrono::duration<double>(source.jitter).count();
  if (jitter_ms > 0.0) text += fmt::format(" +- {:.2g} ms", jitter_ms);
  text += fmt::format(", {} lost, {} damaged", source.lost_frames, source.damaged_frames);
  if (source.clock_drift_ppm) text += fmt::format(", clock {:+.0f} ppm", *source.clock_drift_ppm);
  if (source.reconnections > 0) text += fmt::format(", reconnected {} times", source.reconnections);
  return text;
}

}  // namespace dermis::app
