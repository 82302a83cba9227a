// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "interruption.hpp"

#include <unistd.h>

#include <csignal>
#include <mutex>
#include <thread>

#include "dermis/bytes/files/output_place.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr int kExitSignalled = 128;

struct Notice {
  std::mutex mutex;
  std::string text = "interrupted; nothing is half-written";
};

Notice& notice() {
  static Notice said;
  return said;
}

bool is_ignored(int signal_number) {  // by nohup
  struct sigaction present {};
  ::sigaction(signal_number, nullptr, &present);
  return present.sa_handler == SIG_IGN;
}

/// No handler can remove files; a thread that waits for the signal can.
void wait_for(sigset_t signals) {
  int received = 0;
  if (sigwait(&signals, &received) != 0) return;
  bytes::files::remove_unfinished_files();
  notice().mutex.lock();
  if (!notice().text.empty()) print_notice("dermis: " + notice().text);
  ::_exit(kExitSignalled + received);
}

}  // namespace

void end_when_interrupted() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    if (!is_ignored(signal_number)) sigaddset(&signals, signal_number);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(wait_for, signals).detach();
}

void say_when_interrupted(const std::string& text) {
  const std::lock_guard lock(notice().mutex);
  notice().text = text;
}

}  // namespace dermis::app
