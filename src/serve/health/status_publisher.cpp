// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/health/status_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <utility>

#include "dermis/messages/live_messages.hpp"
#include "serve/health/status_messages.hpp"
#include "serve/topics/suit_transforms.hpp"

namespace dermis::serve {

StatusPublisher::StatusPublisher(const SuitAtWork& work, stream::Server& server) : work_(work), server_(server) {
  const auto add = [&](const char* topic, const messages::MessageType& type) {
    return server_.add_channel(topic, type.name, type.definition);
  };
  channels_.health = add("/health", messages::diagnostics_type());
  channels_.statistics = add("/statistics", messages::statistics_type());
  channels_.transforms = add("/tf", messages::transforms_type());
  channels_.calibration = add("/calibration", messages::calibration_state_type());
}

void StatusPublisher::publish(std::int64_t tick) {
  if (tick % 3 == 0) publish_calibration();
  if (tick % 3 == 1) publish_playback();
  if (tick % 15 == 2) publish_statistics();
  if (tick % 30 == 5) publish_health();
  const std::uint64_t moved = work_.suit.body ? work_.suit.body->version() : 0;
  const bool has_moved = std::exchange(body_version_, moved) != moved;
  if (tick % 30 == 20 || has_moved) publish_transforms();
}

Nanos StatusPublisher::now() const {
  if (work_.suit.playback) return work_.suit.playback->status().now;
  return std::chrono::system_clock::now().time_since_epoch();
}

void StatusPublisher::publish_message(stream::ChannelId channel) {
  server_.publish(channel, now(), message_);
}

void StatusPublisher::publish_statistics() {
  if (!server_.has_subscribers(channels_.statistics)) return;
  messages::Statistics statistics;
  statistics.time = now();
  for (std::size_t k = 0; k < work_.suit.arrays.size(); ++k) {
    statistics.arrays.push_back(statistics_message(work_.suit.arrays[k].name, work_.live.statistics(k)));
  }
  statistics.recording = work_.recorder.recording();
  statistics.recording_file = work_.recorder.path();
  statistics.recording_frames = work_.recorder.frames();
  statistics.recording_left_out = work_.recorder.left_out();
  const stream::ServerStatistics server = server_.statistics();
  statistics.clients = static_cast<std::uint32_t>(server.clients);
  statistics.client_drops = server.dropped;
  messages::encode_statistics(statistics, kSuitFrame, message_);
  publish_message(channels_.statistics);
}

void StatusPublisher::publish_health() {
  if (!server_.has_subscribers(channels_.health)) return;
  messages::encode_diagnostics(diagnoses(), now(), kSuitFrame, message_);
  publish_message(channels_.health);
}

std::vector<messages::Diagnosis> StatusPublisher::diagnoses() const {
  std::vector<messages::Diagnosis> diagnoses;
  for (std::size_t k = 0; k < work_.suit.arrays.size(); ++k) {
    diagnoses.push_back(diagnosis_message(work_.suit.arrays[k].name, *work_.models.of(k), work_.live.statistics(k),
                                          work_.ageing.evidence(k)));
  }
  if (work_.threats) std::ranges::move(work_.threats->diagnoses(), std::back_inserter(diagnoses));
  return diagnoses;
}

void StatusPublisher::publish_transforms() {
  if (!server_.has_subscribers(channels_.transforms)) return;
  messages::encode_transforms(suit_transforms(work_.suit), now(), message_);
  publish_message(channels_.transforms);
}

void StatusPublisher::publish_calibration() {
  if (!server_.has_subscribers(channels_.calibration)) return;
  std::optional<CalibrationProgress> progress = work_.calibration.progress();
  if (!progress) return;
  messages::CalibrationState state = calibration_message(*std::move(progress));
  state.time = now();
  messages::encode_calibration_state(state, kSuitFrame, message_);
  publish_message(channels_.calibration);
}

/// The clock of a recording, ten times a second while it runs and once when it stands still. Who comes while it stands
/// still is told, too, and shown the frame at which it stands.
void StatusPublisher::publish_playback() {
  if (!work_.suit.playback) return;
  live::Playback& playback = *work_.suit.playback;
  const PlaybackStatus status = playback.status();
  const std::uint64_t subscriptions = server_.subscriptions();
  const bool is_somebody_new = subscriptions != std::exchange(last_subscriptions_, subscriptions);
  if (status != last_playback_ || is_somebody_new) server_.playback_changed(status);
  if (is_somebody_new && status.state != PlaybackStatus::State::playing) playback.show_again();
  last_playback_ = status;
}

}  // namespace dermis::serve
