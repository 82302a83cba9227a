// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "out/serve/setup/source_watch.hpp"
#include "out/serve/setup/touch_finder.hpp"

namespace dermis::out::serve {

/// Reads a source as long as it lives, for its readings and for where the array is touched. A recording is read at its
/// own pace. Thread-safe.
class TouchWatch {
 public:
  struct Seen {
    std::uint64_t frames = 0;            ///< So far; 0: `counts` is empty.
    std::vector<float> counts{};         ///< Of the newest frame, row-major.
    bool is_ready = false;               ///< The readings at rest are known.
    std::optional<std::size_t> taxel{};  ///< That is touched, row-major.
    std::string problem{};               ///< Why the source gives no frames (any more).
  };

  using Heard = std::function<void(const RawFrame&)>;

  /// `shape`: of the frames. The options `array` and `stop` are not used. `heard` has each frame, in another thread.
  TouchWatch(live::sources::SourceName name, FrameShape shape, live::sources::SourceOptions options, Heard heard = {});

  [[nodiscard]] FrameShape shape() const noexcept { return shape_; }
  [[nodiscard]] Seen seen();

 private:
  [[nodiscard]] Result<bool> hear(const RawFrame& frame);

  const FrameShape shape_;
  const Heard heard_;
  std::mutex mutex_;
  Seen seen_;
  TouchFinder finder_;
  SourceWatch watch_;  // the last: its thread uses the others
};

}  // namespace dermis::out::serve
