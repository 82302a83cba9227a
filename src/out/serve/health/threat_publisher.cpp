// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/threat_publisher.hpp"

#include <fmt/core.h>

#include <chrono>
#include <utility>

#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {
namespace {

using live::threats::ThreatLimit;
using live::threats::ThreatPhase;
using live::threats::ThreatState;

constexpr Nanos kRepeatPeriod = std::chrono::milliseconds(500);
constexpr Nanos kLogPeriod = std::chrono::seconds(1);

/// `last` may be later than `now` where a recording was sought.
bool is_due(const std::optional<Nanos>& last, Nanos now, Nanos period) {
  return !last || now < *last || now - *last >= period;
}

}  // namespace

bytes::ros_messages::Threat::State state_of(const ThreatLimit& limit, const ThreatState& state) {
  using State = bytes::ros_messages::Threat::State;
  switch (state.phase) {
    case ThreatPhase::clear: return State::clear;
    case ThreatPhase::crossed: return State::crossed;
    case ThreatPhase::standing: break;
  }
  return state.now.value < limit.release_share * limit.limit ? State::latched : State::active;
}

bytes::ros_messages::Diagnosis diagnosis_of(const std::string& array, const ThreatLimit& limit,
                                            const ThreatState& state) {
  bytes::ros_messages::Diagnosis diagnosis;
  diagnosis.level = bytes::ros_messages::Diagnosis::Level::error;
  diagnosis.name = fmt::format("threat '{}' on '{}'", limit.name, array);
  diagnosis.hardware_id = array;
  diagnosis.message = live::threats::describe(limit, state.now);
  const bool is_latched = state_of(limit, state) == bytes::ros_messages::Threat::State::latched;
  diagnosis.values = {{"state", is_latched ? "over, until it is reset" : "there"},
                      {"worst", live::threats::describe(limit, state.worst)},
                      {"first crossed", fmt::format("{:.3f} s", std::chrono::duration<double>(state.crossed).count())}};
  return diagnosis;
}

Result<std::vector<live::threats::ThreatMonitor>> threat_monitors(const ServedSuit& suit) {
  std::vector<live::threats::ThreatMonitor> monitors;
  if (!suit.threats) return monitors;
  for (const ServedArray& array : suit.arrays) {
    Result<live::threats::ThreatMonitor> monitor =
        live::threats::ThreatMonitor::create(*suit.threats, array.name, array.model->array);
    if (!monitor) return bad_input(fmt::format("array '{}': {}", array.name, monitor.error().message));
    monitors.push_back(*std::move(monitor));
  }
  return monitors;
}

Result<EventTopic> ThreatPublisher::make_topic(Topics& topics, SuitRecorder& recorder) {
  return EventTopic::create({.stream = "/threat", .dds = "/threat"}, bytes::ros_messages::threat_type(), topics,
                            recorder);
}

ThreatPublisher::ThreatPublisher(const ServedSuit& suit, std::vector<live::threats::ThreatMonitor> monitors,
                                 EventTopic topic, Log log)
    : limits_(*suit.threats), topic_(std::move(topic)), log_(std::move(log)) {
  for (std::size_t k = 0; k < monitors.size(); ++k) arrays_.emplace_back(std::move(monitors[k]), suit.arrays[k].name);
}

std::vector<websocket::Service> ThreatPublisher::services() {
  return {{"/threats/reset", [this](std::string_view) -> Result<std::string> {
             for (Watched& watched : arrays_) watched.is_reset_wanted = true;
             return std::string("{}");
           }}};
}

void ThreatPublisher::hear(const live::suits::ArrayResult& result) {
  Watched& watched = arrays_[result.array];
  const Nanos time = result.force.time;
  if (watched.is_reset_wanted.exchange(false)) {
    watched.monitor.reset();
    publish(watched, time, false);
  }
  watched.monitor.process(result.force, result.report);
  const bool all = is_due(watched.repeated, time, kRepeatPeriod);
  if (all) watched.repeated = time;
  publish(watched, time, all);
}

void ThreatPublisher::diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const {
  for (const Watched& watched : arrays_) {
    const std::lock_guard lock(watched.standing_mutex);
    for (const ThreatState& state : watched.standing) {
      diagnoses.push_back(diagnosis_of(watched.array, limits_.limits[state.limit], state));
    }
  }
}

void ThreatPublisher::keep_standing(Watched& watched) {
  const std::lock_guard lock(watched.standing_mutex);
  watched.standing.clear();
  for (const ThreatState& state : watched.monitor.states()) {
    if (state.phase == ThreatPhase::standing) watched.standing.push_back(state);
  }
}

/// Publishes which limits began or ended, and with `all` how the other limits stand.
void ThreatPublisher::publish(Watched& watched, Nanos time, bool all) {
  bool is_news = all;
  for (const ThreatState& state : watched.monitor.states()) {
    if (!state.changed && !all) continue;
    is_news = true;
    encode(watched, state, time);
    state.changed ? topic_.publish(time, watched.message) : topic_.show(time, watched.message);
    if (state.changed && state.phase == ThreatPhase::standing) log(watched, state, time);
  }
  if (is_news) keep_standing(watched);
}

/// One line a second at most: the topic has all of them.
void ThreatPublisher::log(Watched& watched, const ThreatState& state, Nanos time) const {
  if (!is_due(watched.logged, time, kLogPeriod)) return;
  watched.logged = time;
  const ThreatLimit& limit = limits_.limits[state.limit];
  log_(fmt::format("threat '{}' on '{}': {}", limit.name, watched.array, live::threats::describe(limit, state.now)));
}

void ThreatPublisher::encode(Watched& watched, const ThreatState& state, Nanos time) const {
  const ThreatLimit& limit = limits_.limits[state.limit];
  bytes::ros_messages::Threat threat;
  threat.time = time;
  threat.name = limit.name;
  threat.array = watched.array;
  threat.zone = limit.zone;
  threat.quantity = live::threats::threat_quantity_names()[static_cast<std::size_t>(limit.quantity)];
  threat.state = state_of(limit, state);
  threat.changed = state.changed;
  threat.crossed = state.crossed;
  threat.value = state.now.value;
  threat.sigma = state.now.sigma;
  threat.worst = state.worst.value;
  threat.limit = limit.limit;
  threat.unit = live::threats::unit_of(limit.quantity);
  threat.x = state.now.position.x;
  threat.y = state.now.position.y;
  bytes::ros_messages::encode_threat(threat, watched.message);
}

Result<std::unique_ptr<Part>> make_threats(Host& host) {
  if (!host.suit.threats) return std::unique_ptr<Part>();
  Result<std::vector<live::threats::ThreatMonitor>> monitors = threat_monitors(host.suit);
  if (!monitors) return monitors.error();
  Result<EventTopic> topic = ThreatPublisher::make_topic(host.topics, host.recorder);
  if (!topic) return topic.error();
  return std::unique_ptr<Part>(std::make_unique<ThreatPublisher>(host.suit, *std::move(monitors), *std::move(topic),
                                                                 [&host](const std::string& line) { host.log(line); }));
}

}  // namespace dermis::out::serve
