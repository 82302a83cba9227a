// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recognition/stream_recogniser.hpp"
#include "serve/frame_resampler.hpp"

namespace dermis::serve {

/// What touches one array at work, from its newtons. Frames are brought to the rate of the examples, of poses to 30 a
/// second. Allocates only when made. Not thread-safe.
class ArrayRecognition {
 public:
  /// Fails where the classes do not fit the array.
  [[nodiscard]] static Result<ArrayRecognition> create(recognition::Classes classes, const std::string& name,
                                                       const ArrayDescription& array);

  /// The answer where there is one to tell: of a gesture once it is over; of a pose when it changes, and ten times a
  /// second. Valid until the next call. Rejected frames are passed over.
  [[nodiscard]] std::optional<recognition::Answer> next(const ForceFrame& force);

  [[nodiscard]] const recognition::Classes& classes() const noexcept { return recogniser_.classes(); }

 private:
  ArrayRecognition(recognition::StreamRecogniser recogniser, double rate_hz, std::size_t taxels);

  [[nodiscard]] bool is_news(const recognition::Answer& answer, Nanos time);

  recognition::StreamRecogniser recogniser_;
  FrameResampler resampler_;
  /// The pose that was told last.
  struct Told {
    std::size_t likeliest = 0;
    recognition::Verdict verdict = recognition::Verdict::known;
    Nanos time{};
  };
  std::optional<Told> told_{};
};

}  // namespace dermis::serve
