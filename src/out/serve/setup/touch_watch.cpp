// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/touch_watch.hpp"

#include <utility>

#include "dermis/live/sources/pacer.hpp"
#include "out/serve/setup/touch_finder.hpp"

namespace dermis::out::serve {

TouchWatch::TouchWatch(live::sources::SourceName name, FrameShape shape, live::sources::SourceOptions options,
                       Heard heard)
    : name_(std::move(name)),
      shape_(shape),
      heard_(std::move(heard)),
      thread_([this, options = std::move(options)]() mutable {
        const Status watched = watch(std::move(options));
        if (watched) return;
        const std::lock_guard lock(mutex_);
        seen_.problem = watched.error().message;
      }) {}

TouchWatch::~TouchWatch() {
  stop_ = true;
  thread_.join();
}

TouchWatch::Seen TouchWatch::seen() const {
  const std::lock_guard lock(mutex_);
  return seen_;
}

void TouchWatch::keep(Seen seen) {
  const std::lock_guard lock(mutex_);
  seen_ = std::move(seen);
}

Status TouchWatch::watch(live::sources::SourceOptions options) {
  ArrayDescription array;
  array.rows = shape_.rows;
  array.cols = shape_.cols;
  if (name_.kind != live::sources::SourceKind::simulation) options.array = &array;
  options.stop = &stop_;
  const Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(name_, options);
  if (!source) return source.error();
  TouchFinder finder(shape_.taxel_count());
  live::sources::Pacer pacer(&stop_);
  std::optional<Nanos> first;
  RawFrame frame;
  for (std::uint64_t frames = 1; !stop_; ++frames) {
    const Result<bool> more = (*source)->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (frame.counts.size() != shape_.taxel_count()) return bad_input("rows and cols are not those of the frames");
    if (!first) first = frame.time;
    if (!(*source)->is_live() && !pacer.wait_until(live::sources::due_after(*first, frame.time))) break;
    finder.add(frame.counts);
    if (heard_) heard_(frame);
    keep({frames, {frame.counts.begin(), frame.counts.end()}, finder.is_ready(), finder.touched()});
  }
  return stop_ || !(*source)->is_live() ? Status(Done{}) : failed("the source has ended");
}

}  // namespace dermis::out::serve
