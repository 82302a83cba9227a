// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/recognition/recogniser.hpp"
#include "dermis/learn/recognition/touch_finder.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

/// The recognition in a stream, and its frames, counted from 0.
struct Recognition {
  Touch frames{};
  Answer answer{};
};

/// Names events in a stream frame by frame: a gesture once it is over, from onset to release, and a pose with every
/// frame. A pose is named from the last half second, but not from before the present touch. Allocates only when made.
/// Not thread-safe.
class StreamRecogniser {
 public:
  /// `source`: as for Recogniser::create(). Fails on classes of gestures whose onset and release were not learned.
  /// Fails also on frames so large that twice the frames of one look would exceed 2^26 readings.
  [[nodiscard]] static Result<StreamRecogniser> create(Classes classes, const Layout& source);

  /// `readings`: of one frame, tared; `extras`: beside it. The answer is valid until the next call.
  [[nodiscard]] std::optional<Recognition> next(std::span<const float> readings, std::span<const float> extras = {});
  /// The gesture that has not yet ended when the stream does.
  [[nodiscard]] std::optional<Recognition> finish();

  [[nodiscard]] const Classes& classes() const noexcept { return recogniser_.classes(); }

 private:
  StreamRecogniser(Recogniser recogniser, const Layout& source, std::size_t window);

  void keep(std::span<const float> readings, std::span<const float> extras);
  [[nodiscard]] Touch held_touch() const;
  [[nodiscard]] Recognition recognise(const Touch& touch);

  Recogniser recogniser_;
  Layout source_;
  std::optional<TouchFinder> finder_;  ///< Of gestures.
  std::size_t window_;                 ///< Most frames that are looked at together.
  std::size_t frame_ = 0;              ///< How many came.
  std::size_t kept_ = 0;               ///< How many of the last ones are in the buffers.
  std::vector<float> readings_;        ///< [2 window, readings]: so that the last ones are always in one piece.
  std::vector<float> extras_;
  std::vector<double> forces_;  ///< Of the same frames.
};

/// Sum of the readings of a frame that are a load.
[[nodiscard]] double force_of(const Layout& layout, std::span<const float> readings);

}  // namespace dermis::learn::recognition
