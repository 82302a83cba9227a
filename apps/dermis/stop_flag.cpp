// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "stop_flag.hpp"

#include <csignal>

namespace dermis::app {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void request_stop(int) {
  stop_requested.store(true);
}

/// Reads that wait are interrupted (no SA_RESTART).
void handle(int signal_number) {
  struct sigaction present {};
  ::sigaction(signal_number, nullptr, &present);
  if (present.sa_handler == SIG_IGN) return;  // nohup
  struct sigaction action {};
  action.sa_handler = request_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(signal_number, &action, nullptr);
}

}  // namespace

std::atomic<bool>& stop_flag() {
  static const bool kInstalled = [] {
    handle(SIGINT);
    handle(SIGTERM);
    handle(SIGHUP);
    return true;
  }();
  static_cast<void>(kInstalled);
  return stop_requested;
}

}  // namespace dermis::app
