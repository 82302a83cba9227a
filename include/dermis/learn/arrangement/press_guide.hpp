// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/arrangement/arrangement.hpp"
#include "dermis/learn/arrangement/press_finder.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::arrangement {

/// Leads a person from place to place. The first second of frames is the rest: nothing may press meanwhile. A channel
/// that has answered already is taken for a mistake at first, and believed when the place is pressed again. Not
/// thread-safe.
class PressGuide {
 public:
  explicit PressGuide(std::size_t places) : answers_(places) {}

  /// Returns whether a press has ended.
  bool add(std::span<const float> counts, Nanos time);

  /// Nothing answers at this place.
  void skip();
  /// The place before this one again.
  void back();

  [[nodiscard]] bool is_ready() const noexcept { return finder_.has_value(); }
  [[nodiscard]] bool is_done() const noexcept { return place_ == answers_.size(); }
  [[nodiscard]] bool is_pressed() const noexcept { return finder_ && finder_->is_pressed(); }
  /// The place to press now.
  [[nodiscard]] std::size_t place() const noexcept { return place_; }
  /// The place whose channel answered to the last press again; this one is to be pressed once more.
  [[nodiscard]] std::optional<std::size_t> repeated() const noexcept { return repeated_; }
  [[nodiscard]] const Answers& answers() const noexcept { return answers_; }
  /// The largest reading so far.
  [[nodiscard]] double most_counts() const noexcept { return most_counts_; }

 private:
  void learn(std::span<const float> counts, Nanos time);
  void take(const Press& press);

  Answers answers_;
  std::size_t place_ = 0;
  std::optional<std::size_t> repeated_;
  std::optional<std::size_t> repeated_channel_;
  double most_counts_ = 0.0;
  std::vector<std::vector<float>> rest_;
  Nanos first_{};
  std::optional<PressFinder> finder_;  // empty: the rest is not known yet
};

}  // namespace dermis::learn::arrangement
