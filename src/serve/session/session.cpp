// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/serve/session.hpp"

#include <fmt/core.h>

#include <cassert>
#include <chrono>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "dermis/files/array_toml.hpp"
#include "dermis/files/content_hash.hpp"
#include "serve/health/ageing_watch.hpp"
#include "serve/topics/broadcaster.hpp"
#include "serve/calibration/calibration_services.hpp"
#include "serve/topics/dds_topics.hpp"
#include "serve/parts/live_parameters.hpp"
#include "serve/suit/models_in_use.hpp"
#include "serve/recognition/recognition_publisher.hpp"
#include "serve/recording/recording_services.hpp"
#include "serve/recording/recordings_folder.hpp"
#include "serve/suit/service_arrays.hpp"
#include "serve/health/status_publisher.hpp"
#include "serve/suit/suit_json.hpp"
#include "serve/recognition/suit_recognition.hpp"
#include "serve/recording/suit_recorder.hpp"
#include "serve/teaching/teaching_services.hpp"
#include "serve/health/threat_publisher.hpp"

namespace dermis::serve {
namespace {

using Notice = std::function<void(const std::string&)>;

constexpr int kInfoLevel = 0;
constexpr int kErrorLevel = 2;
constexpr std::int64_t kTicksToReport = std::int64_t{5} * StatusPublisher::kTicksPerSecond;

std::vector<recordings::RecordedArray> recorded_arrays(const ServedSuit& suit, const ModelsInUse& models) {
  std::vector<recordings::RecordedArray> recorded;
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    const ServedArray& array = suit.arrays[k];
    const std::shared_ptr<const pipeline::Model> model = models.of(k);
    const ArrayDescription& description = model->array;
    recordings::RecordedArray& one = recorded.emplace_back();
    one.name = array.name;
    one.shape = {description.rows, description.cols};
    one.array_toml = files::array_to_toml(description);
    one.pitch = {description.row_pitch_m, description.col_pitch_m};
    const Result<std::string> hash = files::content_hash(array.model_path);
    if (hash && !models.is_new(k)) one.model_hash = *hash;
  }
  return recorded;
}

std::optional<stream::PlaybackService> playback_service(live::Playback* playback) {
  if (playback == nullptr) return std::nullopt;
  return stream::PlaybackService{playback->start(), playback->end(),
                                 [playback](const PlaybackCommand& command) { return playback->control(command); }};
}

/// What listens to every frame, in the order in which it is called.
class FrameListeners {
 public:
  using Listener = std::function<void(const live::ArrayResult&)>;

  /// Before the first frame.
  void add(Listener listener) { listeners_.push_back(std::move(listener)); }
  void call(const live::ArrayResult& result) const {
    for (const Listener& listener : listeners_) listener(result);
  }

 private:
  std::vector<Listener> listeners_;
};

/// What can fail before there is a session.
struct SessionParts {
  std::unique_ptr<stream::Server> server;
  std::unique_ptr<FrameListeners> listeners;
  std::unique_ptr<live::LiveSuit> live;
  std::vector<threats::ThreatMonitor> monitors;
  std::unique_ptr<DdsTopics> dds;  // null: none are wanted
};

/// Takes the sources of the suit.
Result<std::unique_ptr<live::LiveSuit>> make_live(ServedSuit& suit, const FrameListeners& listeners, Notice notice) {
  std::vector<live::LiveArray> arrays;
  for (ServedArray& array : suit.arrays) {
    assert(array.source != nullptr && array.model != nullptr);
    arrays.push_back({array.name, std::move(array.source), array.model, array.surface});
  }
  live::LiveOptions options;
  options.on_result = [&listeners](const live::ArrayResult& result) { listeners.call(result); };
  options.notice = std::move(notice);
  return live::LiveSuit::create(std::move(arrays), std::move(options));
}

Result<SessionParts> make_parts(ServedSuit& suit, const SessionOptions& options) {
  auto listeners = std::make_unique<FrameListeners>();
  Result<std::unique_ptr<live::LiveSuit>> live = make_live(suit, *listeners, options.server.notice);
  if (!live) return live.error();
  Result<std::unique_ptr<stream::Server>> server =
      stream::Server::create(options.server, options.page, playback_service(suit.playback.get()));
  if (!server) return server.error();
  Result<std::vector<threats::ThreatMonitor>> monitors = threat_monitors(suit);
  if (!monitors) return monitors.error();
  Result<std::unique_ptr<DdsTopics>> dds{std::unique_ptr<DdsTopics>()};
  if (options.dds) dds = DdsTopics::create(suit, *options.dds);
  if (!dds) return dds.error();
  return SessionParts{*std::move(server), std::move(listeners), *std::move(live), *std::move(monitors),
                      *std::move(dds)};
}

}  // namespace

/// Joins the parts of a server, which know nothing of each other. Many members: each part is one, in the order in which
/// they are made.
class Session::Implementation {
 public:
  Implementation(ServedSuit suit, SessionParts parts, const SessionOptions& options);
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation();

  /// Begins to answer clients and, where one is wanted, a recording.
  [[nodiscard]] Status start(const SessionOptions& options);
  [[nodiscard]] Status run(const std::atomic<bool>& stop);
  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

 private:
  void listen();
  [[nodiscard]] stream::Handlers handlers();
  [[nodiscard]] std::vector<stream::Service> services();
  [[nodiscard]] Status set_parameter(const stream::Parameter& parameter, const std::string& client);
  [[nodiscard]] Result<std::string> call_calibration(const std::string& name, std::string_view request);
  [[nodiscard]] std::optional<PlayedRecording::PlayedSuit> player();
  [[nodiscard]] Status use_model(std::size_t array, const std::shared_ptr<const pipeline::Model>& model);
  [[nodiscard]] Status use_classes(std::size_t array, recognition::Classes classes);
  void show_suit();
  void show_body();
  void report_failed_recording(const std::string& why);
  void report_recording(std::uint64_t frames);
  void report_left_out();
  void report_tares();
  void publish_to_dds(std::int64_t tick);
  void log(const std::string& line) const;
  void tell(const std::string& line, int level = kErrorLevel);

  const Notice notice_;
  ServedSuit suit_;
  ModelsInUse models_;
  std::unique_ptr<stream::Server> server_;
  std::unique_ptr<FrameListeners> listeners_;
  std::unique_ptr<live::LiveSuit> live_;
  AgeingWatch ageing_;
  SuitRecorder recorder_;
  RecordingServices recordings_;
  Broadcaster broadcaster_;
  RecognitionPublisher recognition_;
  std::optional<ThreatPublisher> threats_;  // empty: nothing is limited
  CalibrationServices calibration_;
  TeachingServices teaching_;
  std::unique_ptr<SuitRecognition> suit_recognition_;  // null: the suit has no classes
  LiveParameters parameters_;
  StatusPublisher status_;
  std::unique_ptr<DdsTopics> dds_;  // null: none are wanted
  std::uint64_t left_out_ = 0;      // frames of the recording, when they were told last
  std::uint64_t left_out_of_dds_ = 0;
};

Session::Implementation::Implementation(ServedSuit suit, SessionParts parts, const SessionOptions& options)
    : notice_(options.server.notice),
      suit_(std::move(suit)),
      models_(suit_),
      server_(std::move(parts.server)),
      listeners_(std::move(parts.listeners)),
      live_(std::move(parts.live)),
      ageing_(suit_),
      recorder_(
          options.record, [this] { return recorded_arrays(suit_, models_); },
          [this](const std::string& why) { report_failed_recording(why); },
          [this](std::uint64_t frames) { report_recording(frames); }),
      recordings_(
          suit_, options, [this] { return recorded_arrays(suit_, models_); }, models_, recorder_, *server_, player()),
      broadcaster_(suit_, *server_),
      recognition_(suit_, *server_, recorder_),
      calibration_(
          service_arrays(suit_),
          [this](std::size_t array, const std::shared_ptr<const pipeline::Model>& model) {
            return use_model(array, model);
          },
          suit_.guide),
      teaching_(
          service_arrays(suit_),
          [this](std::size_t array, recognition::Classes classes) { return use_classes(array, std::move(classes)); }),
      parameters_(suit_, *live_, broadcaster_, recorder_),
      status_(SuitAtWork{suit_, models_, *live_, ageing_, recorder_, calibration_, threats_}, *server_),
      dds_(std::move(parts.dds)) {
  if (suit_.threats) {
    threats_.emplace(suit_, std::move(parts.monitors), *server_, recorder_,
                     [this](const std::string& line) { log(line); });
  }
}

Session::Implementation::~Implementation() {
  if (suit_.playback) suit_.playback->stop();
  live_->stop();
  server_->stop();
  static_cast<void>(recorder_.end());
}

/// A threat is told before anything else is done with its frame. Then clients see and hear what came, then it is
/// learned of. It is recorded last.
void Session::Implementation::listen() {
  if (threats_) listeners_->add([this](const auto& result) { threats_->publish(result); });
  if (dds_) listeners_->add([this](const auto& result) { dds_->publish(result); });
  listeners_->add([this](const auto& result) { broadcaster_.publish(result); });
  listeners_->add([this](const auto& result) { ageing_.add(result); });
  listeners_->add([this](const auto& result) { recognition_.publish(result); });
  if (suit_recognition_) listeners_->add([this](const auto& result) { suit_recognition_->publish(result); });
  listeners_->add([this](const auto& result) { calibration_.feed(result.array, result.raw); });
  listeners_->add([this](const auto& result) { teaching_.feed(result); });
  listeners_->add([this](const auto& result) { recorder_.write(result.array, result.raw); });
  listeners_->add([this](const auto& result) { recordings_.feed(result); });
}

Status Session::Implementation::start(const SessionOptions& options) {
  for (std::size_t k = 0; k < suit_.arrays.size(); ++k) {
    const std::optional<recognition::Classes>& classes = suit_.arrays[k].classes;
    if (!classes) continue;
    if (Status used = recognition_.use(k, *classes); !used) return used;
  }
  if (suit_.classes) {
    Result<std::unique_ptr<SuitRecognition>> recognition = SuitRecognition::create(suit_, *server_, recorder_);
    if (!recognition) return recognition.error();
    suit_recognition_ = *std::move(recognition);
  }
  listen();
  show_suit();
  show_body();
  server_->start(handlers(), services());
  Status begun = options.record.empty() ? Status(Done{}) : recorder_.begin();
  if (begun && recorder_.path() != options.record) log("the recording is '" + recorder_.path() + "'");
  return begun;
}

stream::Handlers Session::Implementation::handlers() {
  return {.parameters = [this] { return parameters_.all(); },
          .set_parameter = [this](const stream::Parameter& parameter,
                                  const std::string& client) { return set_parameter(parameter, client); }};
}

std::vector<stream::Service> Session::Implementation::services() {
  std::vector<stream::Service> services;
  for (const std::string& name : CalibrationServices::names()) {
    services.push_back({name, [this, name](std::string_view request) { return call_calibration(name, request); }});
  }
  for (const std::string& name : TeachingServices::names()) {
    services.push_back({name, [this, name](std::string_view request) { return teaching_.call(name, request); }});
  }
  for (const std::string& name : recordings_.names()) {
    services.push_back({name, [this, name](std::string_view request) { return recordings_.call(name, request); }});
  }
  if (suit_recognition_ && suit_.classes->layout.extras > 0) {
    services.push_back({SuitRecognition::kService,
                        [this](std::string_view request) { return suit_recognition_->take_readings(request); }});
  }
  if (suit_.body) {
    services.push_back({"/body/joints", [this](std::string_view request) -> Result<std::string> {
                          if (Status set = suit_.body->set_joints(request); !set) return set.error();
                          return std::string("{}");
                        }});
  }
  if (threats_) {
    services.push_back({"/threats/reset", [this](std::string_view request) { return threats_->reset(request); }});
  }
  return services;
}

/// A person cannot press what is over.
Result<std::string> Session::Implementation::call_calibration(const std::string& name, std::string_view request) {
  const bool is_over = suit_.playback && suit_.playback->status().state == PlaybackStatus::State::ended;
  if (name == "/calibration/start" && is_over) {
    return bad_input("the recording has ended: play it from its beginning, then begin");
  }
  return calibration_.call(name, request);
}

/// What is played itself plays no other.
std::optional<PlayedRecording::PlayedSuit> Session::Implementation::player() {
  if (suit_.playback) return std::nullopt;
  return [this](const std::string& recording) -> Result<ServedSuit> {
    Result<ServedSuit> played = played_suit(suit_, recording);
    if (!played) return played;
    for (std::size_t k = 0; k < played->arrays.size(); ++k) played->arrays[k].model = models_.of(k);
    return played;
  };
}

/// /suit.json, as the suit is now.
void Session::Implementation::show_suit() {
  server_->set_document("/suit.json", "application/json", suit_json(suit_, models_));
}

/// The meshes of the body, which /suit.json names.
void Session::Implementation::show_body() {
  if (!suit_.body) return;
  for (const BodyFile& file : suit_.body->files()) {
    server_->set_document(file.path, file.path.ends_with(".stl") ? "model/stl" : "model/gltf-binary", file.bytes);
  }
}

Status Session::Implementation::set_parameter(const stream::Parameter& parameter, const std::string& client) {
  Status set = parameters_.set(parameter, client);
  // Others change with it: the file of a recording, the tare of each array.
  if (set && std::holds_alternative<bool>(parameter.value)) server_->parameters_changed();
  return set;
}

Status Session::Implementation::use_model(std::size_t array, const std::shared_ptr<const pipeline::Model>& model) {
  if (Status used = live_->set_model(array, model); !used) return used;
  models_.replace(array, model);
  ageing_.begin_anew(array, *model);
  parameters_.tares().forget(array);
  show_suit();
  server_->parameters_changed();
  return Done{};
}

Status Session::Implementation::use_classes(std::size_t array, recognition::Classes classes) {
  if (Status used = recognition_.use(array, classes); !used) return used;
  suit_.arrays[array].classes = std::move(classes);
  show_suit();
  return Done{};
}

void Session::Implementation::report_failed_recording(const std::string& why) {
  tell("the recording has ended: " + why);
  server_->parameters_changed();
}

void Session::Implementation::report_recording(std::uint64_t frames) {
  tell(fmt::format("recorded {} frames: {}", frames, absolute_path(recorder_.path())), kInfoLevel);
}

void Session::Implementation::log(const std::string& line) const {
  if (notice_) notice_(line);
}

/// The log and all clients.
void Session::Implementation::tell(const std::string& line, int level) {
  log(line);
  server_->status(level, line);
}

/// Here, where no array waits: a log may stall as a disk does.
void Session::Implementation::report_left_out() {
  const std::uint64_t left_out = recorder_.left_out();
  if (left_out != std::exchange(left_out_, left_out) && left_out > 0) {
    tell(fmt::format("the disk of the recording does not follow: {} frames are left out of {}", left_out,
                     recorder_.path()));
  }
  const std::uint64_t of_dds = dds_ ? dds_->left_out() : 0;
  if (of_dds != std::exchange(left_out_of_dds_, of_dds)) {
    tell(fmt::format("the network of DDS does not follow: {} messages are left out", of_dds));
  }
}

void Session::Implementation::report_tares() {
  const std::vector<std::string> news = parameters_.tares().follow();
  for (const std::string& line : news) tell(line, kInfoLevel);
  if (!news.empty()) server_->parameters_changed();
}

void Session::Implementation::publish_to_dds(std::int64_t tick) {
  dds_->publish_suit();
  if (tick % StatusPublisher::kTicksPerSecond == 0) dds_->publish_health(status_.diagnoses(), status_.now());
}

Status Session::Implementation::run(const std::atomic<bool>& stop) {
  live_->start();
  if (suit_.playback) suit_.playback->control({.play = true});
  const auto begin = std::chrono::steady_clock::now();
  for (std::int64_t tick = 0; !stop; ++tick) {
    broadcaster_.publish_points();
    status_.publish(tick);
    report_tares();
    if (dds_) publish_to_dds(tick);
    if (tick % kTicksToReport == 0) report_left_out();
    std::this_thread::sleep_until(begin + Nanos((tick + 1) * 1'000'000'000 / StatusPublisher::kTicksPerSecond));
  }
  if (suit_.playback) suit_.playback->stop();
  live_->stop();
  report_left_out();
  return recorder_.end();
}

Result<std::unique_ptr<Session>> Session::create(ServedSuit suit, const SessionOptions& options) {
  Result<SessionParts> parts = make_parts(suit, options);
  if (!parts) return parts.error();
  auto implementation = std::make_unique<Implementation>(std::move(suit), *std::move(parts), options);
  if (Status started = implementation->start(options); !started) return started.error();
  return std::unique_ptr<Session>(new Session(std::move(implementation)));
}

Session::Session(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Session::~Session() = default;

std::uint16_t Session::port() const noexcept {
  return implementation_->port();
}

Status Session::run(const std::atomic<bool>& stop) {
  return implementation_->run(stop);
}

}  // namespace dermis::serve
