// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/recognition/stream_recogniser.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/recognition/frame_resampler.hpp"

namespace dermis::out::serve {

/// Recognises touches of one array or several at work, from their newtons. Frames are brought to the rate of the
/// examples, of poses to 30 a second. Allocates only when made. Not thread-safe.
class LiveRecognition {
 public:
  /// `arrays`: side by side in each frame, in this order; `further`: readings beside a frame. Fails where the classes
  /// do not fit them.
  [[nodiscard]] static Result<LiveRecognition> create(learn::recognition::Classes classes,
                                                      std::vector<learn::recognition::SensedArray> arrays,
                                                      std::size_t further = 0);

  /// The new answer, if any: for a gesture once it is over; for a pose when it changes, and ten times a second.
  /// `further`: as many as create() was given. Valid until the next call. Rejected frames are passed over.
  [[nodiscard]] std::optional<learn::recognition::Answer> next(const ForceFrame& force,
                                                               std::span<const float> further = {});

  [[nodiscard]] const learn::recognition::Classes& classes() const noexcept { return recogniser_.classes(); }

 private:
  LiveRecognition(learn::recognition::StreamRecogniser recogniser, double rate_hz, std::size_t taxels);

  [[nodiscard]] bool is_news(const learn::recognition::Answer& answer, Nanos time);

  learn::recognition::StreamRecogniser recogniser_;
  FrameResampler resampler_;
  /// The pose that was published last.
  struct Published {
    std::size_t likeliest = 0;
    learn::recognition::Verdict verdict = learn::recognition::Verdict::known;
    Nanos time{};
  };
  std::optional<Published> published_{};
};

}  // namespace dermis::out::serve
