// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::app {

/// Lines that a person types at the terminal while it records are marks of the recording; an empty one ends the label
/// before it. Each is in the file beside the recording at once.
class TypedMarks {
 public:
  /// Listens where the standard input is a terminal.
  explicit TypedMarks(std::string recording);

  /// The first frame is there, from which marks count.
  void begin();

 private:
  void listen(const std::stop_token& stop);
  void take(std::string_view typed);
  void mark(std::string label);

  using Clock = std::chrono::steady_clock;
  const std::string recording_;
  std::mutex mutex_;
  std::optional<Clock::time_point> begin_;
  std::string line_;  // as far as it is typed
  std::vector<bytes::ros_messages::Mark> marks_;
  std::jthread thread_;  // the last: it uses the others
};

}  // namespace dermis::app
