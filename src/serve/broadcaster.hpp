// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"
#include "dermis/stream/server.hpp"
#include "serve/contacts_in_suit.hpp"
#include "serve/suit_points.hpp"

namespace dermis::serve {

/// What comes of the frames -> the channels of docs/stream.md. Thread-safe: each array on a thread of its own.
class Broadcaster {
 public:
  /// `suit` and `server` must outlive it.
  Broadcaster(const ServedSuit& suit, stream::Server& server);

  /// Publishes the frame, if it is due and somebody listens.
  void publish(const live::ArrayResult& result);

  /// The taxels of the whole suit, as they were in the last frames that were streamed.
  void publish_points();

  void set_rate_hz(double rate_hz) noexcept { rate_hz_ = rate_hz; }
  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }

  /// Of the last frame that was streamed.
  [[nodiscard]] Nanos last_time() const noexcept { return Nanos(last_time_ns_.load()); }

 private:
  /// An array, touched by its thread alone.
  struct Channels {
    const ServedArray* array = nullptr;
    ContactsInSuit contacts;
    FrameShape shape{};
    messages::Pitch pitch{};
    stream::ChannelId raw = 0;
    stream::ChannelId conductance = 0;
    stream::ChannelId force = 0;
    std::optional<Nanos> last{};  // Frame that came.
    Nanos due{};
    std::vector<std::uint8_t> message{};
  };

  [[nodiscard]] bool is_due(Channels& channels, Nanos time) const noexcept;
  void publish_images(Channels& channels, const live::ArrayResult& result);
  void publish_contacts(Channels& channels, const live::ArrayResult& result);

  stream::Server& server_;
  std::deque<Channels> arrays_;
  stream::ChannelId contacts_;
  stream::ChannelId points_channel_;
  SuitPoints points_;
  std::vector<std::uint8_t> points_message_;
  std::atomic<double> rate_hz_{60.0};
  std::atomic<std::int64_t> last_time_ns_{0};
};

}  // namespace dermis::serve
