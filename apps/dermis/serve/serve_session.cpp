// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/serve_session.hpp"

#include <fmt/core.h>

#include <chrono>
#include <span>
#include <utility>

#include "dermis/files/array_toml.hpp"
#include "dermis/files/content_hash.hpp"
#include "pacer.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"
#include "viewer/viewer_assets.hpp"

namespace dermis::app {
namespace {

constexpr int kTicksPerSecond = 30;

std::vector<CalibratedArray> calibrated_arrays(const ServedSuit& suit) {
  std::vector<CalibratedArray> arrays;
  for (const ServedArray& one : suit.arrays) arrays.push_back({one.name, one.description, one.model_path});
  return arrays;
}

}  // namespace

stream::PlaybackState playback_state(const live::PlaybackStatus& status, bool did_seek) {
  using State = live::PlaybackStatus::State;
  stream::PlaybackState state;
  state.status = status.state == State::playing  ? stream::PlaybackState::Status::playing
                 : status.state == State::paused ? stream::PlaybackState::Status::paused
                                                 : stream::PlaybackState::Status::ended;
  state.now = status.now;
  state.speed = static_cast<float>(status.speed);
  state.did_seek = did_seek;
  return state;
}

ServeSession::ServeSession(ServedSuit suit, const std::string& record)
    : suit_(std::move(suit)),
      record_(record),
      calibration_(std::make_unique<CalibrationServices>(
          calibrated_arrays(suit_),
          [this](std::size_t array, std::shared_ptr<const pipeline::Model> model) {
            return use_model(array, std::move(model));
          })),
      recorder_([this](const std::string& why) {
        say("the recording has ended: " + why);
        server_->status(2, "the recording has ended: " + why);
        server_->parameters_changed();
      }),
      tared_(suit_.arrays.size()),
      replaced_models_(suit_.arrays.size()) {}

ServeSession::~ServeSession() {
  if (suit_.playback) suit_.playback->stop();
  if (live_) live_->stop();
  if (server_) server_->stop();
  static_cast<void>(recorder_.end());
}

Result<std::unique_ptr<ServeSession>> ServeSession::create(ServedSuit suit, const stream::ServerOptions& options,
                                                           const std::string& record) {
  std::unique_ptr<ServeSession> session(new ServeSession(std::move(suit), record));
  if (Status started = session->start_suit(); !started) return started.error();
  if (Status started = session->start_server(options); !started) return started.error();
  if (!record.empty()) {
    if (Status begun = session->switch_recording(true); !begun) return begun.error();
  }
  return session;
}

Status ServeSession::start_suit() {
  std::vector<live::LiveArray> arrays;
  for (std::size_t k = 0; k < suit_.arrays.size(); ++k) {
    const ServedArray& array = suit_.arrays[k];
    arrays.push_back({array.name, std::move(suit_.sources[k]), array.model, array.surface});
  }
  live::LiveOptions options;
  options.on_result = [this](const live::ArrayResult& result) { on_result(result); };
  options.notice = say;
  Result<std::unique_ptr<live::LiveSuit>> live = live::LiveSuit::create(std::move(arrays), std::move(options));
  if (!live) return live.error();
  live_ = *std::move(live);
  return Done{};
}

Status ServeSession::start_server(const stream::ServerOptions& options) {
  const std::span<const stream::Asset> page = viewer::assets();
  stream::Handlers handlers;
  handlers.parameters = [this] { return parameters(); };
  handlers.set_parameter = [this](const stream::Parameter& parameter) { return set_parameter(parameter); };
  std::vector<stream::Service> services;
  for (const std::string& name : CalibrationServices::names()) {
    services.push_back({name, [this, name](std::string_view request) { return calibration_->call(name, request); }});
  }
  Result<std::unique_ptr<stream::Server>> server =
      stream::Server::create(options, {page.begin(), page.end()}, std::move(handlers), std::move(services), playback());
  if (!server) return server.error();
  server_ = *std::move(server);
  server_->set_document("/suit.json", "application/json", suit_json(suit_));
  broadcaster_ = std::make_unique<Broadcaster>(suit_, *server_);
  add_status_channels();
  server_->start();
  return Done{};
}

void ServeSession::add_status_channels() {
  const auto add = [this](const char* topic, const messages::MessageType& type) {
    return server_->add_channel(topic, type.name, type.definition);
  };
  channels_.health = add("/health", messages::diagnostics_type());
  channels_.statistics = add("/statistics", messages::statistics_type());
  channels_.transforms = add("/tf", messages::transforms_type());
  channels_.calibration = add("/calibration", messages::calibration_state_type());
}

void ServeSession::on_result(const live::ArrayResult& result) {
  recorder_.write(result.array, result.raw);
  calibration_->feed(result.array, result.raw);
  broadcaster_->publish(result);
}

std::optional<stream::Playback> ServeSession::playback() {
  if (!suit_.playback) return std::nullopt;
  stream::Playback playback;
  playback.start = suit_.playback->start();
  playback.end = suit_.playback->end();
  playback.control = [this](const stream::PlaybackControl& control) {
    const live::PlaybackCommand command{control.play, static_cast<double>(control.speed), control.seek};
    return playback_state(suit_.playback->control(command), control.seek.has_value());
  };
  return playback;
}

Status ServeSession::run() {
  live_->start();
  if (suit_.playback) suit_.playback->control({.play = true});
  Pacer pacer(&stop_flag());
  for (std::int64_t tick = 0; pacer.wait_until(Nanos(tick * 1'000'000'000 / kTicksPerSecond)); ++tick) {
    broadcaster_->publish_points();
    if (tick % 3 == 0) publish_calibration();
    if (tick % 3 == 1) publish_playback();
    if (tick % 15 == 2) publish_statistics();
    if (tick % 30 == 5) publish_health();
    if (tick % 30 == 20) publish_transforms();
  }
  if (suit_.playback) suit_.playback->stop();
  live_->stop();
  return recorder_.end();
}

std::vector<recordings::RecordedArray> ServeSession::recorded_arrays() const {
  std::vector<recordings::RecordedArray> recorded;
  for (std::size_t k = 0; k < suit_.arrays.size(); ++k) {
    const ServedArray& array = suit_.arrays[k];
    const std::shared_ptr<const pipeline::Model> model = this->model(k);
    const ArrayDescription& description = model->array;
    recordings::RecordedArray& one = recorded.emplace_back();
    one.name = array.name;
    one.shape = {description.rows, description.cols};
    one.array_toml = files::array_to_toml(description);
    one.pitch = {description.row_pitch_m, description.col_pitch_m};
    const Result<std::string> hash = files::content_hash(array.model_path);
    if (hash && !replaced_models_[k]) one.model_hash = *hash;
  }
  return recorded;
}

Status ServeSession::use_model(std::size_t array, std::shared_ptr<const pipeline::Model> model) {
  if (Status used = live_->set_model(array, model); !used) return used;
  const std::lock_guard lock(models_mutex_);
  suit_.arrays[array].model = std::move(model);
  replaced_models_[array] = true;
  tared_[array] = false;  // the new model begins at its own zero
  server_->set_document("/suit.json", "application/json", suit_json(suit_));
  server_->parameters_changed();
  return Done{};
}

std::shared_ptr<const pipeline::Model> ServeSession::model(std::size_t array) const {
  const std::lock_guard lock(models_mutex_);
  return suit_.arrays[array].model;
}

Nanos ServeSession::now() const {
  if (suit_.playback) return suit_.playback->status().now;
  return std::chrono::system_clock::now().time_since_epoch();
}

}  // namespace dermis::app
