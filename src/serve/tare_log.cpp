// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/tare_log.hpp"

#include <fmt/chrono.h>
#include <fmt/ranges.h>

namespace dermis::serve {

std::string TareLog::add(const std::string& what, bool on, const std::string& who,
                         std::chrono::system_clock::time_point when) {
  std::string line =
      fmt::format("{:%Y-%m-%d %H:%M:%S} UTC: {} {} by {}", fmt::gmtime(std::chrono::system_clock::to_time_t(when)),
                  what, on ? "was tared" : "got back the zero of its calibration", who);
  const std::lock_guard lock(mutex_);
  lines_.push_front(line);
  if (lines_.size() > kMostLines) lines_.pop_back();
  return line;
}

std::string TareLog::text() const {
  const std::lock_guard lock(mutex_);
  return fmt::format("{}", fmt::join(lines_, "\n"));
}

}  // namespace dermis::serve
