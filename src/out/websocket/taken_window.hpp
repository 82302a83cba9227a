// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>

namespace dermis::out::websocket {

/// How much may be on its way to a client that reports what it has taken. It is the amount that it takes in kLongest,
/// so that nothing arrives much older. Not thread-safe.
class TakenWindow {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLongest{400};
  /// While less is on its way, more may follow however large it is: the line is not to stand idle.
  static constexpr std::uint64_t kLeastBytes = 1500;

  /// `bytes`: of the `sent` ones so far; less than before is left out.
  void take(std::uint64_t bytes, std::uint64_t sent, Clock::time_point now);

  /// Whether `next` bytes may follow `sent` ones; always where the client sends no reports.
  [[nodiscard]] bool is_open(std::uint64_t sent, std::uint64_t next) const noexcept;

 private:
  bool has_report_ = false;
  std::uint64_t taken_ = 0;
  double rate_ = 0.0;  // [bytes/s], that it can take
  std::uint64_t mark_ = 0;
  Clock::time_point marked_{};
};

}  // namespace dermis::out::websocket
