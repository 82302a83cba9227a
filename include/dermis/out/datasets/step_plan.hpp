// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::datasets {

/// Time of a step of a clock.
[[nodiscard]] Nanos step_time(Nanos start, double fps, std::uint64_t step);

/// Says when the steps of an episode are, and which of them no later frame can change. Frames of each array come by
/// their times; those of two arrays may cross.
///
/// The first step is half a frame after the first array has its window full. So the frames of an even rate lie in the
/// middle between steps, and jitter moves none into another window. The last step is the first that has all
/// frames behind it.
class StepPlan {
 public:
  /// Steps wait no longer than this for an array that is silent.
  static constexpr Nanos kPatience = std::chrono::seconds(1);

  /// `window`: frames of a window, >= 1. `fps` > 0.
  StepPlan(std::size_t arrays, std::size_t window, double fps);
  /// Steps at given times, which rise; the plan ends with them.
  StepPlan(std::size_t arrays, std::vector<Nanos> times);

  /// A frame has come.
  void see(std::size_t array, Nanos time);
  /// The time of the newest frame; empty before the first.
  [[nodiscard]] std::optional<Nanos> newest() const noexcept { return newest_; }

  /// The times of the steps that are due and were not taken yet. `is_over`: no frame follows.
  [[nodiscard]] std::vector<Nanos> take_due(bool is_over);

  /// The time of the next step; empty where that is not known yet, and where none is left.
  [[nodiscard]] std::optional<Nanos> next() const;
  /// All of the given times are taken.
  [[nodiscard]] bool is_done() const noexcept { return fps_ <= 0.0 && taken_ == given_.size(); }

 private:
  struct Seen {
    std::uint64_t frames = 0;
    Nanos newest{};
  };
  [[nodiscard]] std::optional<Nanos> settled_until() const;
  [[nodiscard]] std::vector<Nanos> take_given(bool is_over);

  std::vector<Seen> seen_;
  std::size_t window_ = 1;
  double fps_ = 0.0;
  std::vector<Nanos> given_;
  std::optional<Nanos> start_;
  std::optional<Nanos> newest_;
  std::uint64_t taken_ = 0;
};

}  // namespace dermis::out::datasets
