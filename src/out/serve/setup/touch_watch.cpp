// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/touch_watch.hpp"

#include <utility>

namespace dermis::out::serve {

TouchWatch::TouchWatch(live::sources::SourceName name, FrameShape shape, live::sources::SourceOptions options,
                       Heard heard)
    : shape_(shape),
      heard_(std::move(heard)),
      finder_(shape.taxel_count()),
      watch_(std::move(name), shape, std::move(options),
             [this](const FrameSource& /*source*/, const RawFrame& frame) { return hear(frame); }) {}

TouchWatch::Seen TouchWatch::seen() {
  const std::optional<SourceWatch::Ended> ended = watch_.ended();
  const std::lock_guard lock(mutex_);
  if (ended && !ended->how) seen_.problem = ended->how.error().message;
  if (ended && ended->how && ended->was_live) seen_.problem = "the source has ended";
  return seen_;
}

Result<bool> TouchWatch::hear(const RawFrame& frame) {
  if (frame.counts.size() != shape_.taxel_count()) return bad_input("rows and cols are not those of the frames");
  if (heard_) heard_(frame);
  const std::lock_guard lock(mutex_);
  finder_.add(frame.counts);
  ++seen_.frames;
  seen_.counts.assign(frame.counts.begin(), frame.counts.end());
  seen_.is_ready = finder_.is_ready();
  seen_.taxel = finder_.touched();
  return true;
}

}  // namespace dermis::out::serve
