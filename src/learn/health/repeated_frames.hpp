// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dermis::learn::health {

/// Frames whose readings are those of the frame before, all of them. Where noise changes most readings from frame to
/// frame, such a frame is stale: it was not measured anew.
class RepeatedFrames {
 public:
  void add(std::span<const float> counts);

  /// Frames at the end, or between others, that are all the same.
  [[nodiscard]] std::optional<std::string> finding() const;
  /// Frames that come more often than they are measured.
  [[nodiscard]] std::optional<std::string> remark() const;

 private:
  [[nodiscard]] bool has_noise() const noexcept;

  std::vector<float> last_;
  std::size_t frames_ = 0;
  std::size_t repeated_ = 0;
  std::size_t changed_readings_ = 0;  ///< In all frames.
  std::size_t run_ = 0;               ///< Repeated frames up to the last one,
  std::size_t longest_ = 0;           ///< and the most of them,
  std::size_t longest_end_ = 0;       ///< with the number of their last.
};

}  // namespace dermis::learn::health
