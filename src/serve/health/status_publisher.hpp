// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/core/playback.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"
#include "dermis/stream/server.hpp"
#include "serve/health/ageing_watch.hpp"
#include "serve/calibration/calibration_services.hpp"
#include "serve/suit/models_in_use.hpp"
#include "serve/recording/suit_recorder.hpp"
#include "serve/health/threat_publisher.hpp"

namespace dermis::serve {

/// What there is to tell of.
struct SuitAtWork {
  const ServedSuit& suit;
  const ModelsInUse& models;
  const live::LiveSuit& live;
  const AgeingWatch& ageing;
  const SuitRecorder& recorder;
  const CalibrationServices& calibration;
  const std::optional<ThreatPublisher>& threats;  ///< Empty: nothing is limited.
};

/// The channels of docs/stream.md that tell how the work goes, and where a playback is. Not thread-safe.
class StatusPublisher {
 public:
  static constexpr int kTicksPerSecond = 30;

  /// The parts of `work` and `server` must outlive it.
  StatusPublisher(const SuitAtWork& work, stream::Server& server);

  /// To be called for each tick: publishes what is due with it.
  void publish(std::int64_t tick);

  /// How each array is, and the threats that are there.
  [[nodiscard]] std::vector<messages::Diagnosis> diagnoses() const;
  /// By the clock of the recording that is played, else by that of the machine.
  [[nodiscard]] Nanos now() const;

 private:
  struct Channels {
    stream::ChannelId health = 0;
    stream::ChannelId statistics = 0;
    stream::ChannelId transforms = 0;
    stream::ChannelId calibration = 0;
  };

  void publish_statistics();
  void publish_health();
  void publish_transforms();
  void publish_calibration();
  void publish_playback();
  void publish_message(stream::ChannelId channel);

  const SuitAtWork work_;
  stream::Server& server_;
  Channels channels_;
  PlaybackStatus last_playback_{};
  std::uint64_t last_subscriptions_ = 0;  // when the playback was told last
  std::uint64_t body_version_ = 0;        // of which /tf was published
  std::vector<std::uint8_t> message_;
};

}  // namespace dermis::serve
