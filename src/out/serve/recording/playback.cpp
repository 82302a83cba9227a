// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/playback.hpp"

#include <cstdint>
#include <memory>
#include <utility>

#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {
namespace {

/// Publishes the position in the played recording.
class PlaybackClock final : public Part {
 public:
  PlaybackClock(live::suits::Playback& playback, websocket::Server& server) : playback_(playback), server_(server) {}

  /// Ten times a second while it runs and once when it stands still. A client that comes while it stands still gets it,
  /// too, and sees the frame at which it stands.
  void tick(std::int64_t tick) override {
    if (tick % 3 != 1) return;
    const PlaybackStatus status = playback_.status();
    const std::uint64_t subscriptions = server_.subscriptions();
    const bool is_somebody_new = subscriptions != std::exchange(last_subscriptions_, subscriptions);
    if (status != last_ || is_somebody_new) server_.playback_changed(status);
    if (is_somebody_new && status.state != PlaybackStatus::State::playing) playback_.show_again();
    last_ = status;
  }

 private:
  live::suits::Playback& playback_;
  websocket::Server& server_;
  PlaybackStatus last_{};
  std::uint64_t last_subscriptions_ = 0;
};

}  // namespace

Result<std::unique_ptr<Part>> make_playback(Host& host) {
  if (!host.suit.playback) return std::unique_ptr<Part>();
  return std::unique_ptr<Part>(std::make_unique<PlaybackClock>(*host.suit.playback, host.server));
}

}  // namespace dermis::out::serve
