// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::out::serve {

/// Reads a source until it ends, or until its hearer has enough. A recording is read at its own pace. It has a thread
/// of its own; in a page, which has one thread, ended() reads what has come.
class SourceWatch {
 public:
  /// Has each frame, in that thread. False: it has enough. An error ends the watch.
  using Heard = std::function<Result<bool>(const FrameSource&, const RawFrame&)>;

  struct Ended {
    Status how = Done{};
    bool was_open = false;
    bool was_live = false;  ///< It should have no end.
  };

  /// `shape`: that of the frames; empty: any. The options `array` and `stop` are not used.
  SourceWatch(live::sources::SourceName name, std::optional<FrameShape> shape, live::sources::SourceOptions options,
              Heard heard);
  SourceWatch(const SourceWatch&) = delete;
  SourceWatch& operator=(const SourceWatch&) = delete;
  /// Does the same as stop().
  ~SourceWatch();

  /// Empty: it goes on.
  [[nodiscard]] std::optional<Ended> ended();
  /// Ends it. Nothing is heard from then on.
  Ended stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::out::serve
