// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/session.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/recorded_arrays.hpp"
#include "out/serve/recording/recordings_folder.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/session/make_live.hpp"
#include "out/serve/topics/mark_book.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {
namespace {

/// Arrays that hear what the server publishes would hear each frame again, without an end.
Status check_topics(const ServedSuit& suit, const std::vector<std::string>& published, std::uint32_t domain) {
  for (const ServedArray& array : suit.arrays) {
    const Result<live::sources::SourceName> from = live::sources::SourceName::parse(array.from);
    if (!from) continue;
    for (const std::string& topic : published) {
      if (!from->hears(domain, topic)) continue;
      return bad_input(
          fmt::format("array '{}': comes from '{}' of domain {}, which this server publishes itself; "
                      "give its arrays other names, or serve them in another domain",
                      array.name, topic, domain));
    }
  }
  return Done{};
}

}  // namespace

/// Makes the parts of a server and their common objects, and is their clock.
class Session::Implementation {
 public:
  explicit Implementation(ServedSuit suit) : suit_(std::move(suit)), models_(suit_) {}
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation();

  [[nodiscard]] Status make(const SessionOptions& options);
  /// Begins to answer clients and, where one is wanted, a recording.
  [[nodiscard]] Status start();
  [[nodiscard]] Status run(const std::atomic<bool>& stop);
  void work();
  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

 private:
  [[nodiscard]] Status make_parts();
  [[nodiscard]] std::unique_ptr<SuitRecorder> make_recorder(const std::string& wanted);
  [[nodiscard]] websocket::Handlers handlers();

  ServedSuit suit_;
  ModelsInUse models_;
  std::unique_ptr<websocket::Server> server_;
  std::unique_ptr<Topics> topics_;
  std::unique_ptr<SuitRecorder> recorder_;
  std::unique_ptr<MarkBook> marks_;
  std::unique_ptr<live::suits::LiveSuit> live_;
  std::optional<Host> host_;
  PartList parts_;
  std::chrono::steady_clock::time_point next_tick_{};  // of work()
  std::int64_t ticks_ = 0;
};

Status Session::Implementation::make(const SessionOptions& options) {
  Result<std::unique_ptr<live::suits::LiveSuit>> live = make_live(suit_, parts_, options);
  if (!live) return live.error();
  live_ = *std::move(live);
  Result<std::unique_ptr<websocket::Server>> server =
      websocket::Server::create(options.server, options.page, playback_service(suit_.playback.get()));
  if (!server) return server.error();
  server_ = *std::move(server);
  Result<std::unique_ptr<Topics>> topics = Topics::create(*server_, options.dds);
  if (!topics) return topics.error();
  topics_ = *std::move(topics);
  recorder_ = make_recorder(options.record.empty() ? options.recordings : options.record);
  Result<std::unique_ptr<MarkBook>> marks = MarkBook::create(*topics_, *recorder_);
  if (!marks) return marks.error();
  marks_ = *std::move(marks);
  host_.emplace(Host{suit_, options, models_, *server_, *live_, *topics_, *recorder_, *marks_, parts_});
  if (Status made = make_parts(); !made) return made;
  return options.dds ? check_topics(suit_, topics_->dds_topics(), options.dds->domain) : Done{};
}

std::unique_ptr<SuitRecorder> Session::Implementation::make_recorder(const std::string& wanted) {
  const auto failed = [this](const std::string& why) {
    host_->tell_error("the recording has ended: " + why);
    server_->parameters_changed();
  };
  const auto written = [this](std::uint64_t frames) {
    host_->notify(fmt::format("recorded {} frames: {}", frames, absolute_path(recorder_->path())));
  };
  return std::make_unique<SuitRecorder>(
      wanted, [this] { return recorded_arrays(suit_, models_); }, failed, written);
}

Status Session::Implementation::make_parts() {
  for (PartMaker* const make : part_makers()) {
    Result<std::unique_ptr<Part>> part = make(*host_);
    if (!part) return part.error();
    if (*part) parts_.add(*std::move(part));
  }
  return Done{};
}

Status Session::Implementation::start() {
  if (Status prepared = parts_.prepare(); !prepared) return prepared;
  host_->show_suit();
  server_->start(handlers(), parts_.services());
  const std::string& wanted = host_->options.record;
  if (wanted.empty()) return Done{};
  if (Status begun = recorder_->begin(); !begun) return begun;
  if (recorder_->path() != wanted) host_->log("the recording is '" + recorder_->path() + "'");
  return Done{};
}

websocket::Handlers Session::Implementation::handlers() {
  const auto set = [this](const websocket::Parameter& parameter, const std::string& client) {
    Status set = parts_.set(parameter, client);
    // Others change with it: the file of a recording, the tare of each array.
    if (set && std::holds_alternative<bool>(parameter.value)) server_->parameters_changed();
    return set;
  };
  return {.parameters = [this] { return parts_.parameters(); }, .set_parameter = set};
}

Status Session::Implementation::run(const std::atomic<bool>& stop) {
  live_->start();
  if (suit_.playback) suit_.playback->control({.play = true});
  const auto begin = std::chrono::steady_clock::now();
  for (std::int64_t tick = 0; !stop; ++tick) {
    parts_.tick(tick);
    std::this_thread::sleep_until(begin + Nanos((tick + 1) * 1'000'000'000 / Part::kTicksPerSecond));
  }
  if (suit_.playback) suit_.playback->stop();
  live_->stop();
  parts_.finish();
  return recorder_->end();
}

/// A page that slept does not make up for the ticks of that time.
void Session::Implementation::work() {
  if (ticks_ == 0 && suit_.playback) suit_.playback->control({.play = true});
  live_->work();
  const auto now = std::chrono::steady_clock::now();
  if (now < next_tick_) return;
  next_tick_ = std::max(now, next_tick_ + Nanos(1'000'000'000 / Part::kTicksPerSecond));
  parts_.tick(ticks_++);
}

Session::Implementation::~Implementation() {
  if (suit_.playback) suit_.playback->stop();
  if (live_) live_->stop();
  if (server_) server_->stop();
  if (recorder_) static_cast<void>(recorder_->end());
}

Result<std::unique_ptr<Session>> Session::create(ServedSuit suit, const SessionOptions& options) {
  auto implementation = std::make_unique<Implementation>(std::move(suit));
  if (Status made = implementation->make(options); !made) return made.error();
  if (Status started = implementation->start(); !started) return started.error();
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

void Session::work() {
  implementation_->work();
}

}  // namespace dermis::out::serve
