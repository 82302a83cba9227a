// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/stream/server.hpp"
#include "serve/broadcaster.hpp"
#include "serve/calibration_services.hpp"
#include "serve/served_suit.hpp"
#include "serve/suit_recorder.hpp"

namespace dermis::app {

/// As the stream tells it.
[[nodiscard]] stream::PlaybackState playback_state(const live::PlaybackStatus& status, bool did_seek);

/// A suit at work and the server that shows it: `dermis serve` without its command line.
class ServeSession {
 public:
  /// `record`: a recording to begin with; later ones take their names from it. Empty: none.
  [[nodiscard]] static Result<std::unique_ptr<ServeSession>> create(ServedSuit suit,
                                                                    const stream::ServerOptions& options,
                                                                    const std::string& record);
  ServeSession(const ServeSession&) = delete;
  ServeSession& operator=(const ServeSession&) = delete;
  ~ServeSession();

  /// Until the stop flag is set.
  [[nodiscard]] Status run();

  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

 private:
  struct StatusChannels {
    stream::ChannelId health = 0;
    stream::ChannelId statistics = 0;
    stream::ChannelId transforms = 0;
    stream::ChannelId calibration = 0;
  };

  ServeSession(ServedSuit suit, const std::string& record);
  [[nodiscard]] Status start_suit();
  [[nodiscard]] Status start_server(const stream::ServerOptions& options);
  void add_status_channels();
  void on_result(const live::ArrayResult& result);

  [[nodiscard]] std::vector<stream::Parameter> parameters() const;
  [[nodiscard]] Status set_parameter(const stream::Parameter& parameter);
  [[nodiscard]] Status set_number(const std::string& name, double value);
  [[nodiscard]] Status set_switch(const std::string& name, bool value);
  [[nodiscard]] Status set_tare(const std::string& name, bool value);
  [[nodiscard]] Status switch_recording(bool on);
  [[nodiscard]] std::string next_recording() const;
  [[nodiscard]] std::vector<recordings::RecordedArray> recorded_arrays() const;
  [[nodiscard]] Status use_model(std::size_t array, std::shared_ptr<const pipeline::Model> model);
  [[nodiscard]] std::optional<stream::Playback> playback();

  [[nodiscard]] std::shared_ptr<const pipeline::Model> model(std::size_t array) const;
  [[nodiscard]] Nanos now() const;
  void publish_statistics();
  void publish_health();
  void publish_transforms();
  void publish_calibration();
  void publish_playback();
  void publish(stream::ChannelId channel);

  mutable std::mutex models_mutex_;  // Of the models in suit_: a calibration replaces them.
  ServedSuit suit_;
  std::string record_;  // First recording, then the pattern of the names of the next.
  std::unique_ptr<CalibrationServices> calibration_;
  SuitRecorder recorder_;
  std::unique_ptr<live::LiveSuit> live_;
  std::unique_ptr<stream::Server> server_;
  std::unique_ptr<Broadcaster> broadcaster_;
  StatusChannels channels_;
  std::vector<std::atomic<bool>> tared_;
  std::vector<std::atomic<bool>> replaced_models_;
  live::PlaybackStatus last_playback_{};
  std::vector<std::uint8_t> message_;
};

}  // namespace dermis::app
