// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "dermis/learn/recognition/stream_recogniser.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "recognising/force_source.hpp"

namespace dermis::recognising {

struct RecognitionInput {
  std::string classes;   ///< As for learn::recognition::read_classes().
  ForceInput loads{};    ///< Its array is that of the examples.
  double rate_hz = 0.0;  ///< Frames a second of the source; 0: as many as the examples had.
};

/// The recognition in a source.
struct SourceRecognition {
  learn::recognition::Recognition recognition{};  ///< Its frames count from the first of the source.
  Nanos time{};                                   ///< Time of the frame with which it was known.
};

/// Names what happens in a source. Not thread-safe.
class SourceRecogniser {
 public:
  /// Fails where the classes cannot be read or cannot name what comes from the source, and where that cannot be opened.
  /// Errors name the file or, as the commands call it, the option.
  [[nodiscard]] static Result<SourceRecogniser> open(const RecognitionInput& input);

  /// Reads on until something is recognised; nothing at the end of the source. Frames of a tare are passed over. The
  /// answer is valid until the next call.
  [[nodiscard]] Result<std::optional<SourceRecognition>> next();

  [[nodiscard]] const learn::recognition::Classes& classes() const noexcept { return recogniser_.classes(); }
  /// False: each pose is recognised in a single frame, and gestures must come at the rate of the examples.
  [[nodiscard]] bool knows_rate() const noexcept { return knows_rate_; }

 private:
  SourceRecogniser(ForceSource source, learn::recognition::StreamRecogniser recogniser, bool knows_rate,
                   const live::sources::SourceOptions& options);

  [[nodiscard]] Result<bool> next_frame();
  void tell_troubles() const;
  [[nodiscard]] SourceRecognition of_source(learn::recognition::Recognition recognition) const;

  ForceSource source_;
  learn::recognition::StreamRecogniser recogniser_;
  bool knows_rate_;
  const std::atomic<bool>* stop_;  ///< May be null.
  std::function<void(const std::string&)> notice_;
  std::size_t tare_frames_ = 0;
  bool has_ended_ = false;
};

}  // namespace dermis::recognising
