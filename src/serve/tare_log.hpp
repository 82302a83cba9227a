// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>

namespace dermis::serve {

/// Who took which zero when: the last of them, a line each. Thread-safe.
class TareLog {
 public:
  static constexpr std::size_t kMostLines = 20;

  /// `what`: an array, or all of them; `on`: its present state is zero, else the zero of the calibration. Returns the
  /// line: "2026-11-22 10:15:00 UTC: chest was tared by 127.0.0.1:53412".
  std::string add(const std::string& what, bool on, const std::string& who, std::chrono::system_clock::time_point when);

  /// The newest first.
  [[nodiscard]] std::string text() const;

 private:
  mutable std::mutex mutex_;
  std::deque<std::string> lines_;
};

}  // namespace dermis::serve
