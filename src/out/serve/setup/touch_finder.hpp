// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace dermis::out::serve {

/// Finds where an unknown array is pressed: at the reading farthest from its rest. Not thread-safe.
class TouchFinder {
 public:
  static constexpr std::size_t kRestFrames = 15;  ///< The first ones: nothing may press meanwhile.

  explicit TouchFinder(std::size_t taxels);

  /// `counts`: one reading a taxel. Readings that are not numbers are left out.
  void add(std::span<const float> counts);

  /// It knows the readings at rest.
  [[nodiscard]] bool is_ready() const noexcept { return frames_ >= kRestFrames; }
  /// Empty where no reading of the last frame stands out of the noise.
  [[nodiscard]] std::optional<std::size_t> touched() const noexcept { return touched_; }

 private:
  void learn(std::span<const float> counts);
  void look(std::span<const float> counts);

  std::vector<float> lowest_;   // at rest
  std::vector<float> highest_;  // at rest
  float noise_ = 0.0F;          // the widest range at rest [counts]
  std::size_t frames_ = 0;
  std::optional<std::size_t> touched_;
};

}  // namespace dermis::out::serve
