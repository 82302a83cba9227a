// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// Compares the frames of a device with the rate that its layout describes.
class DescribedRate {
 public:
  explicit DescribedRate(std::optional<double> rate_hz) : described_hz_(rate_hz) {}

  void add(Nanos time) noexcept {
    if (frames_++ == 0) first_ = time;
    last_ = time;
  }

  /// Five seconds have come, which are enough to judge. Once.
  [[nodiscard]] bool is_due() noexcept {
    if (!described_hz_ || was_due_ || last_ - first_ < std::chrono::seconds(5)) return false;
    return was_due_ = true;
  }

  [[nodiscard]] bool was_due() const noexcept { return was_due_; }

  /// "111 frames a second where 100 are described", where they differ by more than 5 %; empty where they do not, and
  /// before eleven frames.
  [[nodiscard]] std::string difference() const {
    constexpr std::uint64_t kFewest = 11;
    const double seconds = std::chrono::duration<double>(last_ - first_).count();
    if (!described_hz_ || frames_ < kFewest || !(seconds > 0.0)) return {};
    const double rate_hz = static_cast<double>(frames_ - 1) / seconds;
    if (std::abs(rate_hz / *described_hz_ - 1.0) <= 0.05) return {};
    return text(rate_hz) + " frames a second where " + text(*described_hz_) + " are described";
  }

 private:
  /// With three digits at most behind the point.
  static std::string text(double rate_hz) {
    std::string text =
        std::to_string(std::round((rate_hz < 10.0 ? 1e3 : 1.0) * rate_hz) / (rate_hz < 10.0 ? 1e3 : 1.0));
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }

  std::optional<double> described_hz_;
  bool was_due_ = false;
  std::uint64_t frames_ = 0;
  Nanos first_{};
  Nanos last_{};
};

}  // namespace dermis::bytes::devices
