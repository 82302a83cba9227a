// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/source_watch.hpp"

#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "dermis/live/sources/pacer.hpp"
#include "out/serve/setup/watched_source.hpp"

namespace dermis::out::serve {

class SourceWatch::Implementation {
 public:
  Implementation(live::sources::SourceName name, std::optional<FrameShape> shape, live::sources::SourceOptions options,
                 Heard heard)
      : heard_(std::move(heard)),
        thread_([this, name = std::move(name), shape, options = std::move(options)]() mutable {
          options.stop = &stop_;
          Ended ended = watch(open_watched(name, shape, options));
          const std::lock_guard lock(mutex_);
          ended_ = std::move(ended);
        }) {}
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() { stop(); }

  [[nodiscard]] std::optional<Ended> ended() {
    const std::lock_guard lock(mutex_);
    return ended_;
  }

  Ended stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return *ended_;
  }

 private:
  [[nodiscard]] Ended watch(const Result<std::unique_ptr<FrameSource>>& source) {
    if (!source) return {.how = source.error()};
    return {.how = read(**source), .was_open = true, .was_live = (*source)->is_live()};
  }

  Status read(FrameSource& source) {
    live::sources::Pacer pacer(&stop_);
    std::optional<Nanos> first;
    RawFrame frame;
    while (!stop_) {
      const Result<bool> more = source.next(frame);
      if (!more) return more.error();
      if (!*more) break;
      if (!first) first = frame.time;
      if (!source.is_live() && !pacer.wait_until(live::sources::due_after(*first, frame.time))) break;
      const Result<bool> wants_more = heard_(source, frame);
      if (!wants_more) return wants_more.error();
      if (!*wants_more) break;
    }
    return Done{};
  }

  const Heard heard_;
  std::mutex mutex_;
  std::optional<Ended> ended_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;  // the last: it uses the others
};

SourceWatch::SourceWatch(live::sources::SourceName name, std::optional<FrameShape> shape,
                         live::sources::SourceOptions options, Heard heard)
    : implementation_(std::make_unique<Implementation>(std::move(name), shape, std::move(options), std::move(heard))) {}

SourceWatch::~SourceWatch() = default;

std::optional<SourceWatch::Ended> SourceWatch::ended() {
  return implementation_->ended();
}

SourceWatch::Ended SourceWatch::stop() {
  return implementation_->stop();
}

}  // namespace dermis::out::serve
