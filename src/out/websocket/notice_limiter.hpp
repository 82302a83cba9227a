// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace dermis::out::websocket {

/// One line a kind of event and 10 seconds for the log, with the number of those that were kept back before it.
/// Not thread-safe.
class NoticeLimiter {
 public:
  using Clock = std::chrono::steady_clock;

  explicit NoticeLimiter(std::function<void(const std::string&)> notice) : notice_(std::move(notice)) {}

  /// `kind` must be one of a few: it is remembered.
  void notify(const std::string& kind, const std::string& line, Clock::time_point now = Clock::now()) {
    if (!notice_) return;
    const auto [entry, is_new] = kinds_.try_emplace(kind);
    Kind& known = entry->second;
    if (!is_new && now - known.last < kPause) {
      ++known.kept_back;
      return;
    }
    notice_(known.kept_back == 0 ? line : line + " (and " + std::to_string(known.kept_back) + " more like it)");
    known = {now, 0};
  }

 private:
  static constexpr std::chrono::seconds kPause{10};
  struct Kind {
    Clock::time_point last{};
    std::uint64_t kept_back = 0;
  };

  std::function<void(const std::string&)> notice_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace dermis::out::websocket
