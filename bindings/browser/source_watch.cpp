// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// serve::SourceWatch for one thread: who asks for its end reads what has come.
#include "out/serve/setup/source_watch.hpp"

#include <utility>

#include "dermis/live/sources/pacer.hpp"
#include "out/serve/setup/watched_source.hpp"

namespace dermis::out::serve {

class SourceWatch::Implementation {
 public:
  Implementation(const live::sources::SourceName& name, std::optional<FrameShape> shape,
                 live::sources::SourceOptions options, Heard heard)
      : heard_(std::move(heard)), source_(open_watched(name, shape, std::move(options))) {
    if (!source_) ended_ = Ended{.how = source_.error()};
  }

  [[nodiscard]] std::optional<Ended> ended() {
    if (!ended_) {
      if (const Result<bool> goes_on = read(); !goes_on || !*goes_on) end(goes_on ? Status(Done{}) : goes_on.error());
    }
    return ended_;
  }

  Ended stop() {
    if (!ended_) end(Done{});
    return *ended_;
  }

 private:
  void end(Status how) {
    ended_ = Ended{.how = std::move(how), .was_open = true, .was_live = (*source_)->is_live()};
    source_ = failed("it has ended");
  }

  /// All that has come. False: nothing more does, or is wanted.
  Result<bool> read() {
    while (is_due()) {
      if (has_frame_) {
        has_frame_ = false;
        const Result<bool> wants_more = heard_(**source_, frame_);
        if (!wants_more || !*wants_more) return wants_more;
      }
      const Result<Polled> polled = (*source_)->poll(frame_);
      if (!polled) return polled.error();
      if (*polled != Polled::frame) return *polled == Polled::nothing;
      has_frame_ = true;
      if (!first_) first_ = frame_.time;
    }
    return true;
  }

  [[nodiscard]] bool is_due() const {
    const bool has_pace = (*source_)->is_live() || !has_frame_;
    return has_pace || live::sources::due_after(*first_, frame_.time) <= pacer_.elapsed();
  }

  const Heard heard_;
  Result<std::unique_ptr<FrameSource>> source_;
  std::optional<Ended> ended_;
  live::sources::Pacer pacer_{nullptr};
  std::optional<Nanos> first_;
  RawFrame frame_;  // the newest, which may not be due yet
  bool has_frame_ = false;
};

SourceWatch::SourceWatch(live::sources::SourceName name, std::optional<FrameShape> shape,
                         live::sources::SourceOptions options, Heard heard)
    : implementation_(std::make_unique<Implementation>(name, shape, std::move(options), std::move(heard))) {}

SourceWatch::~SourceWatch() = default;

std::optional<SourceWatch::Ended> SourceWatch::ended() {
  return implementation_->ended();
}

SourceWatch::Ended SourceWatch::stop() {
  return implementation_->stop();
}

}  // namespace dermis::out::serve
