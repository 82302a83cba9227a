// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/result.hpp"

/// Where touches begin and end in a stream: docs/reasons/recognition.md has the rule.
namespace dermis::learn::recognition {

/// The limits of a touch, as forces (sums of the readings of a frame) and frames.
struct TouchLimits {
  double onset = 1.0;             ///< Force above the idle level from which on there is a touch, > 0.
  double release_share = 0.3;     ///< Share of the touch's peak force, 0 ... 1, below which it is released.
  std::size_t gap_frames = 3;     ///< So many frames in a row without force end a touch, 1 ... 1000.
  std::size_t before_frames = 0;  ///< Frames before the onset that belong to a touch, at most 1000.
  std::size_t after_frames = 0;   ///< Frames after the release that belong to a touch, at most 1000.

  [[nodiscard]] Status validate() const;
  bool operator==(const TouchLimits&) const = default;
};

/// Frames of a touch, counted from the first that the finder saw; both are within.
struct Touch {
  std::size_t first = 0;
  std::size_t last = 0;

  bool operator==(const Touch&) const = default;
};

/// Follows the force of a stream. The idle level is the least force of the last frames without a touch, and stays while
/// one lasts. Allocates only when made. Not thread-safe.
class TouchFinder {
 public:
  explicit TouchFinder(const TouchLimits& limits);

  /// Takes the force of the next frame; gives a touch once it is over.
  [[nodiscard]] std::optional<Touch> next(double force);
  /// The touch that has not yet ended when the stream does.
  [[nodiscard]] std::optional<Touch> finish();

  [[nodiscard]] bool is_touched() const noexcept { return is_touched_; }

 private:
  static constexpr std::size_t kIdleFrames = 20;

  void idle(double force);
  [[nodiscard]] double idle_level() const;
  [[nodiscard]] Touch end_touch();

  TouchLimits limits_;
  std::vector<double> recent_;  ///< Forces of the last kIdleFrames or gap_frames, whichever are more; a ring.
  std::size_t idle_count_ = 0;  ///< How many of those were without a touch.
  std::size_t frame_ = 0;       ///< Of the next frame.
  bool is_touched_ = false;
  double level_ = 0.0;
  double peak_ = 0.0;
  std::size_t onset_ = 0;
  std::size_t last_held_ = 0;
  std::size_t free_from_ = 0;  ///< First frame that belongs to no touch before.
};

/// How well touches are found.
struct FindingReport {
  std::size_t labelled = 0;
  std::size_t found = 0;   ///< The ones of those with an intersection over union of at least 0.5.
  std::size_t others = 0;  ///< Touches that were found where no label is.
};
[[nodiscard]] FindingReport judge_finding(std::span<const Touch> labelled, std::span<const Touch> found);

/// All touches of a stream.
[[nodiscard]] std::vector<Touch> find_touches(const TouchLimits& limits, std::span<const double> forces);

/// The limits that find labelled touches best again. `forces`: of each frame of the stream; `labelled`: at least one.
[[nodiscard]] TouchLimits learn_touch_limits(std::span<const double> forces, std::span<const Touch> labelled);

}  // namespace dermis::learn::recognition
