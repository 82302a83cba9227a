// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

namespace dermis::live::sources {

/// Sets a flag when another is set, or after a time: SourceOptions::stop of who does not wait longer.
class Patience {
 public:
  /// `stop` may be null; else it must outlive this.
  Patience(const std::atomic<bool>* stop, std::chrono::milliseconds patience);
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;
  ~Patience() = default;

  [[nodiscard]] const std::atomic<bool>* over() const noexcept { return &over_; }

 private:
  std::atomic<bool> over_ = false;
  std::jthread thread_;
};

}  // namespace dermis::live::sources
