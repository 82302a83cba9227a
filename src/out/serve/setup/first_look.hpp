// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/setup/source_watch.hpp"

namespace dermis::out::serve {

/// How long a device may take to send its first frame.
inline constexpr std::chrono::seconds kPatience{8};

/// The traffic of a source, as far as it shows the array.
struct FirstLook {
  bool has_frames = false;
  std::optional<FrameShape> shape{};  ///< Shape of the frames; without frames the likely one.
  std::string message{};              ///< Describes the bytes, or what they lack.
  std::vector<std::uint8_t> bytes{};  ///< The first of those of which no frame was made, at most 64 KiB.
};

/// Reads the first frame, for at most kPatience. Bytes that make no frame are described and are no error. Not
/// thread-safe.
class SourceLook {
 public:
  SourceLook(live::sources::SourceName name, live::sources::SourceOptions options);

  /// Empty: not yet; ask again. Fails where the source cannot be opened or read.
  [[nodiscard]] std::optional<Result<FirstLook>> found();

 private:
  [[nodiscard]] live::sources::SourceOptions heard_by(live::sources::SourceOptions options);
  [[nodiscard]] Result<FirstLook> outcome(const SourceWatch::Ended& ended);
  void explain();

  const live::sources::SourceName name_;
  const std::atomic<bool>* stop_;
  const std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::now() + kPatience;
  std::mutex mutex_;
  FirstLook found_;
  SourceWatch watch_;  // the last: its thread uses the others
};

/// Waits for it.
[[nodiscard]] Result<FirstLook> first_look(const live::sources::SourceName& name, live::sources::SourceOptions options);

}  // namespace dermis::out::serve
