// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/touch_watch.hpp"

#include <utility>

#include "serve/touch_finder.hpp"

namespace dermis::serve {

TouchWatch::TouchWatch(sources::SourceName name, FrameShape shape, sources::SourceOptions options)
    : name_(std::move(name)), shape_(shape), thread_([this, options = std::move(options)]() mutable {
        const Status watched = watch(std::move(options));
        if (!watched) keep({.problem = watched.error().message});
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

Status TouchWatch::watch(sources::SourceOptions options) {
  ArrayDescription array;
  array.rows = shape_.rows;
  array.cols = shape_.cols;
  if (name_.kind != sources::SourceKind::simulation) options.array = &array;
  options.stop = &stop_;
  const Result<std::unique_ptr<FrameSource>> source = sources::open_source(name_, options);
  if (!source) return source.error();
  TouchFinder finder(shape_.taxel_count());
  RawFrame frame;
  while (!stop_) {
    const Result<bool> more = (*source)->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (frame.counts.size() != shape_.taxel_count()) return bad_input("rows and cols are not those of the frames");
    finder.add(frame.counts);
    keep({.is_ready = finder.is_ready(), .taxel = finder.touched()});
  }
  return stop_ ? Status(Done{}) : failed("the source has ended");
}

}  // namespace dermis::serve
