// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"

namespace dermis::learn::calibration {

/// There are loads, they name frames that exist, and a pressure can be turned into a force.
[[nodiscard]] Status check_loads(const ArrayDescription& array, std::size_t frame_count, std::span<const Load> loads);

/// The force of a load in all [N].
[[nodiscard]] double total_newtons(const Load& load, const ArrayDescription& array);

/// The sum of the loads of every frame [N]; none for unlabelled frames.
[[nodiscard]] std::vector<std::optional<double>> newtons_of_frames(const ArrayDescription& array,
                                                                   std::size_t frame_count,
                                                                   std::span<const Load> loads);

/// The loads of every frame; none for unlabelled frames.
class LoadsOfFrames {
 public:
  /// Refers to `loads`, which name frames below `frame_count`.
  LoadsOfFrames(std::span<const Load> loads, std::size_t frame_count);
  LoadsOfFrames(const LoadsOfFrames&) = delete;
  LoadsOfFrames& operator=(const LoadsOfFrames&) = delete;

  [[nodiscard]] std::size_t frame_count() const noexcept { return first_.size() - 1; }
  [[nodiscard]] std::span<const Load> operator[](std::size_t frame) const noexcept {
    return loads_.subspan(first_[frame], first_[frame + 1] - first_[frame]);
  }

 private:
  std::vector<Load> sorted_;          // by frame, where they are not
  std::span<const Load> loads_;       // by frame
  std::vector<std::uint32_t> first_;  // of each frame in loads_ [frames + 1]
};

/// Known forces of every taxel by the loads of one frame: `known_newtons` [taxels], `totals` and `unloaded`. Taxels
/// that the sheet does not have carry nothing.
void expand_loads(const ArrayDescription& array, std::span<const Load> loads, Sample& sample);

/// The forces that a film over the lines feels: those of taxels, and totals evenly over theirs; not a number: not
/// known.
[[nodiscard]] std::vector<float> film_newtons(std::vector<float> newtons, const std::vector<TotalForce>& totals);

}  // namespace dermis::learn::calibration
