// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recognition/stream_recogniser.hpp"

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

  void begin_anew(const ForceFrame& force);
  [[nodiscard]] std::optional<recognition::Answer> follow(std::span<const float> newtons);
  void interpolate(const ForceFrame& force, double share);
  [[nodiscard]] bool is_news(const recognition::Answer& answer, Nanos time);

  recognition::StreamRecogniser recogniser_;
  Nanos period_;                 ///< Of the frames that are looked at; 0: all are.
  std::optional<Nanos> last_{};  ///< Frame that came.
  std::vector<float> last_newtons_;
  std::vector<float> between_;  ///< Newtons between two frames.
  Nanos due_{};                 ///< Time of the next that is looked at.
  /// The pose that was told last.
  struct Told {
    std::size_t likeliest = 0;
    recognition::Verdict verdict = recognition::Verdict::known;
    Nanos time{};
  };
  std::optional<Told> told_{};
};

}  // namespace dermis::serve
