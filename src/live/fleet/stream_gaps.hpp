// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace dermis::live::fleet {

/// Counts what is missing in a stream, and names the first gaps.
class StreamGaps {
 public:
  /// `place`: of the stream, for what is told.
  StreamGaps(std::string place, std::function<void(const std::string&)> notice)
      : place_(std::move(place)), notice_(std::move(notice)) {}

  /// `what` of the message: "is damaged". `frames` as far as it says; 0: not known.
  void add(std::uint64_t message, const std::string& what, std::uint64_t frames) {
    ++gaps_;
    frames_ += frames;
    const std::string many = frames > 0 ? std::to_string(frames) + " frames" : "its frames";
    if (gaps_ <= kMostNamed) tell("message " + std::to_string(message) + " " + what + ": " + many + " are missing");
    if (gaps_ == kMostNamed) tell("more such messages are only counted");
  }
  /// At the end of a range.
  void tell_all() {
    if (gaps_ > 0) tell("lacks " + std::to_string(frames_) + " frames in " + std::to_string(gaps_) + " gaps");
    gaps_ = 0;
  }
  void tell(const std::string& line) const {
    if (notice_) notice_("'" + place_ + "': " + line);
  }

 private:
  static constexpr std::uint64_t kMostNamed = 20;

  const std::string place_;
  const std::function<void(const std::string&)> notice_;
  std::uint64_t gaps_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace dermis::live::fleet
