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
#include "serve/broadcaster.hpp"
#include "serve/calibration_services.hpp"
#include "serve/live_parameters.hpp"
#include "serve/models_in_use.hpp"
#include "serve/recognition_publisher.hpp"
#include "serve/status_publisher.hpp"
#include "serve/suit_json.hpp"
#include "serve/suit_recognition.hpp"
#include "serve/suit_recorder.hpp"
#include "serve/teaching_services.hpp"
#include "serve/threat_publisher.hpp"

namespace dermis::serve {
namespace {

using Notice = std::function<void(const std::string&)>;
using Listener = std::function<void(const live::ArrayResult&)>;

constexpr int kErrorLevel = 2;
constexpr std::int64_t kTicksToReport = std::int64_t{5} * StatusPublisher::kTicksPerSecond;

std::vector<CalibratedArray> calibrated_arrays(const ServedSuit& suit) {
  std::vector<CalibratedArray> arrays;
  for (const ServedArray& one : suit.arrays) arrays.push_back({one.name, one.description, one.model_path});
  return arrays;
}

std::vector<TaughtArray> taught_arrays(const ServedSuit& suit) {
  std::vector<TaughtArray> arrays;
  for (const ServedArray& array : suit.arrays) arrays.push_back({array.name, array.model->array, array.model_path});
  return arrays;
}

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

}  // namespace

class Session::Implementation {
 public:
  Implementation(ServedSuit suit, const SessionOptions& options);
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation();

  [[nodiscard]] Status start(const SessionOptions& options);
  [[nodiscard]] Status run(const std::atomic<bool>& stop);
  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

 private:
  [[nodiscard]] Status make_suit();
  [[nodiscard]] Status make_server(const SessionOptions& options);
  [[nodiscard]] Status make_publishers();
  [[nodiscard]] std::vector<Listener> listeners_in_order();
  [[nodiscard]] Status set_parameter(const stream::Parameter& parameter);
  [[nodiscard]] Status use_model(std::size_t array, const std::shared_ptr<const pipeline::Model>& model);
  [[nodiscard]] Status use_classes(std::size_t array, recognition::Classes classes);
  void report_failed_recording(const std::string& why);
  void report_left_out();
  void tell(const std::string& line);

  const Notice notice_;
  ServedSuit suit_;
  ModelsInUse models_;
  CalibrationServices calibration_;
  TeachingServices teaching_;
  SuitRecorder recorder_;
  std::unique_ptr<live::LiveSuit> live_;
  std::unique_ptr<stream::Server> server_;
  std::optional<Broadcaster> broadcaster_;
  std::optional<RecognitionPublisher> recognition_;
  std::unique_ptr<SuitRecognition> suit_recognition_;  // null: the suit has no classes
  std::unique_ptr<ThreatPublisher> threats_;           // null: nothing is limited
  std::optional<LiveParameters> parameters_;
  std::optional<StatusPublisher> status_;
  /// What listens to every frame, in this order: a threat is told before anything else is done with its frame, then
  /// what clients see and hear, then what is learned of it. It is recorded last.
  std::vector<Listener> listeners_;
  std::uint64_t left_out_ = 0;  // frames of the recording, when they were told last
};

Session::Implementation::Implementation(ServedSuit suit, const SessionOptions& options)
    : notice_(options.server.notice),
      suit_(std::move(suit)),
      models_(suit_),
      calibration_(
          calibrated_arrays(suit_),
          [this](std::size_t array, const std::shared_ptr<const pipeline::Model>& model) {
            return use_model(array, model);
          },
          suit_.guide),
      teaching_(
          taught_arrays(suit_),
          [this](std::size_t array, recognition::Classes classes) { return use_classes(array, std::move(classes)); }),
      recorder_(
          options.record, [this] { return recorded_arrays(suit_, models_); },
          [this](const std::string& why) { report_failed_recording(why); }) {}

Session::Implementation::~Implementation() {
  if (suit_.playback) suit_.playback->stop();
  if (live_) live_->stop();
  if (server_) server_->stop();
  static_cast<void>(recorder_.end());
}

Status Session::Implementation::start(const SessionOptions& options) {
  if (Status made = make_suit(); !made) return made;
  if (Status made = make_server(options); !made) return made;
  if (Status made = make_publishers(); !made) return made;
  parameters_.emplace(suit_, *live_, *broadcaster_, recorder_);
  status_.emplace(SuitAtWork{suit_, models_, *live_, recorder_, calibration_, threats_.get()}, *server_);
  listeners_ = listeners_in_order();
  server_->start();
  return options.record.empty() ? Status(Done{}) : recorder_.begin();
}

Status Session::Implementation::make_suit() {
  std::vector<live::LiveArray> arrays;
  for (ServedArray& array : suit_.arrays) {
    assert(array.source != nullptr && array.model != nullptr);
    arrays.push_back({array.name, std::move(array.source), array.model, array.surface});
  }
  live::LiveOptions options;
  options.on_result = [this](const live::ArrayResult& result) {
    for (const Listener& listener : listeners_) listener(result);
  };
  options.notice = notice_;
  Result<std::unique_ptr<live::LiveSuit>> live = live::LiveSuit::create(std::move(arrays), std::move(options));
  if (!live) return live.error();
  live_ = *std::move(live);
  return Done{};
}

Status Session::Implementation::make_server(const SessionOptions& options) {
  stream::Handlers handlers;
  handlers.parameters = [this] { return parameters_->all(); };
  handlers.set_parameter = [this](const stream::Parameter& parameter) { return set_parameter(parameter); };
  std::vector<stream::Service> services;
  for (const std::string& name : CalibrationServices::names()) {
    services.push_back({name, [this, name](std::string_view request) { return calibration_.call(name, request); }});
  }
  for (const std::string& name : TeachingServices::names()) {
    services.push_back({name, [this, name](std::string_view request) { return teaching_.call(name, request); }});
  }
  if (suit_.classes && suit_.classes->layout.extras > 0) {
    services.push_back({SuitRecognition::kService,
                        [this](std::string_view request) { return suit_recognition_->take_readings(request); }});
  }
  if (suit_.threats) {
    services.push_back({"/threats/reset", [this](std::string_view request) { return threats_->reset(request); }});
  }
  Result<std::unique_ptr<stream::Server>> server = stream::Server::create(
      options.server, options.page, std::move(handlers), std::move(services), playback_service(suit_.playback.get()));
  if (!server) return server.error();
  server_ = *std::move(server);
  server_->set_document("/suit.json", "application/json", suit_json(suit_, models_));
  return Done{};
}

Status Session::Implementation::make_publishers() {
  broadcaster_.emplace(suit_, *server_);
  recognition_.emplace(suit_, *server_, recorder_);
  for (std::size_t k = 0; k < suit_.arrays.size(); ++k) {
    const std::optional<recognition::Classes>& classes = suit_.arrays[k].classes;
    if (!classes) continue;
    if (Status used = recognition_->use(k, *classes); !used) return used;
  }
  if (suit_.classes) {
    Result<std::unique_ptr<SuitRecognition>> made = SuitRecognition::create(suit_, *server_, recorder_);
    if (!made) return made.error();
    suit_recognition_ = *std::move(made);
  }
  Result<std::unique_ptr<ThreatPublisher>> threats =
      ThreatPublisher::create(suit_, *server_, recorder_, [this](const std::string& line) {
        if (notice_) notice_(line);
      });
  if (!threats) return threats.error();
  threats_ = *std::move(threats);
  return Done{};
}

std::vector<Listener> Session::Implementation::listeners_in_order() {
  std::vector<Listener> listeners;
  if (threats_) listeners.emplace_back([this](const auto& result) { threats_->publish(result); });
  listeners.emplace_back([this](const auto& result) { broadcaster_->publish(result); });
  listeners.emplace_back([this](const auto& result) { recognition_->publish(result); });
  if (suit_recognition_) listeners.emplace_back([this](const auto& result) { suit_recognition_->publish(result); });
  listeners.emplace_back([this](const auto& result) { calibration_.feed(result.array, result.raw); });
  listeners.emplace_back([this](const auto& result) { teaching_.feed(result); });
  listeners.emplace_back([this](const auto& result) { recorder_.write(result.array, result.raw); });
  return listeners;
}

Status Session::Implementation::set_parameter(const stream::Parameter& parameter) {
  Status set = parameters_->set(parameter);
  // Others change with it: the file of a recording, the tare of each array.
  if (set && std::holds_alternative<bool>(parameter.value)) server_->parameters_changed();
  return set;
}

Status Session::Implementation::use_model(std::size_t array, const std::shared_ptr<const pipeline::Model>& model) {
  if (Status used = live_->set_model(array, model); !used) return used;
  models_.replace(array, model);
  parameters_->forget_tare(array);
  server_->set_document("/suit.json", "application/json", suit_json(suit_, models_));
  server_->parameters_changed();
  return Done{};
}

Status Session::Implementation::use_classes(std::size_t array, recognition::Classes classes) {
  if (Status used = recognition_->use(array, classes); !used) return used;
  suit_.arrays[array].classes = std::move(classes);
  server_->set_document("/suit.json", "application/json", suit_json(suit_, models_));
  return Done{};
}

void Session::Implementation::report_failed_recording(const std::string& why) {
  tell("the recording has ended: " + why);
  server_->parameters_changed();
}

/// The log and all clients.
void Session::Implementation::tell(const std::string& line) {
  if (notice_) notice_(line);
  server_->status(kErrorLevel, line);
}

/// Here, where no array waits: a log may stall as a disk does.
void Session::Implementation::report_left_out() {
  const std::uint64_t left_out = recorder_.left_out();
  if (left_out != std::exchange(left_out_, left_out) && left_out > 0) {
    tell(fmt::format("the disk of the recording does not follow: {} frames are left out of {}", left_out,
                     recorder_.path()));
  }
}

Status Session::Implementation::run(const std::atomic<bool>& stop) {
  live_->start();
  if (suit_.playback) suit_.playback->control({.play = true});
  const auto begin = std::chrono::steady_clock::now();
  for (std::int64_t tick = 0; !stop; ++tick) {
    broadcaster_->publish_points();
    status_->publish(tick);
    if (tick % kTicksToReport == 0) report_left_out();
    std::this_thread::sleep_until(begin + Nanos((tick + 1) * 1'000'000'000 / StatusPublisher::kTicksPerSecond));
  }
  if (suit_.playback) suit_.playback->stop();
  live_->stop();
  report_left_out();
  return recorder_.end();
}

Result<std::unique_ptr<Session>> Session::create(ServedSuit suit, const SessionOptions& options) {
  auto implementation = std::make_unique<Implementation>(std::move(suit), options);
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
