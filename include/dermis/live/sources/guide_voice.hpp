// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::sources {

/// The present task of a person at an array that is being calibrated.
struct GuideWords {
  bool press = false;     ///< The weight is to lie on the taxel; else nothing is to lie on the array.
  bool is_wrong = false;  ///< Something else is pressed than was asked for.
  std::size_t taxel = 0;  ///< Row-major.
  double weight_n = 0.0;
  std::optional<std::size_t> together_with{};  ///< Another taxel, to be pressed at the same time with as much.
  Nanos hold_time{};                           ///< How long a weight is to lie.
};

/// Between a calibration that asks for presses and the simulated hand that does them (sim:rehearsal). Thread-safe.
class GuideVoice {
 public:
  /// There is a hand that listens.
  void listen() { has_listener_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool has_listener() const { return has_listener_.load(std::memory_order_relaxed); }

  void speak(const GuideWords& words);

  /// The last words; at first, nothing is to be pressed.
  [[nodiscard]] GuideWords words() const;

 private:
  std::atomic<bool> has_listener_ = false;
  mutable std::mutex mutex_;
  GuideWords words_;
};

}  // namespace dermis::live::sources
