// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// A program that runs beside this one, with its output and an empty input. Neither it nor what it starts outlives this
/// object, but where they leave its process group. Not thread-safe.
class ChildProcess {
 public:
  /// `command`: the program, found as a shell finds it, and its arguments; not empty. Gives SIGCHLD its usual meaning:
  /// a process that ignores it cannot wait for another. Fails where there is no such program.
  [[nodiscard]] static Result<ChildProcess> start(const std::vector<std::string>& command);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// Its exit status, 128 + n where signal n ended it; empty while it runs.
  [[nodiscard]] std::optional<int> exit_status() noexcept;

  /// SIGTERM, so that it may end what must be ended, and where that does not end it within 2 s, SIGKILL.
  void stop() noexcept;

 private:
  explicit ChildProcess(int pid) : pid_(pid) {}

  int pid_;  // of POSIX; 0: it has been waited for
  std::optional<int> exit_status_;
};

}  // namespace dermis::app
