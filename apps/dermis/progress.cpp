// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

namespace dermis::app {
namespace {

constexpr int kBarWidth = 40;
constexpr int kTerminalSteps = 100;
constexpr int kPlainSteps = 4;

}  // namespace

Progress::Progress() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  end_line();
}

void Progress::show(const std::string& stage, double share) {
  if (stage != stage_) {
    end_line();
    stage_ = stage;
    last_shown_ = -1;
  }
  const int steps = is_terminal_ ? kTerminalSteps : kPlainSteps;
  const int step = static_cast<int>(share * steps);
  if (step <= last_shown_) return;
  last_shown_ = step;
  if (is_terminal_) {
    const int filled = step * kBarWidth / kTerminalSteps;
    fmt::print(stderr, "\r{:<12} [{:#<{}}{:.<{}}] {:3} %", stage, "", filled, "", kBarWidth - filled, step);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}: {} %\n", stage, step * 100 / kPlainSteps);
  }
  std::fflush(stderr);
}

void Progress::end_line() {
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

}  // namespace dermis::app
