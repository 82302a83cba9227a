// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/topics/event_topic.hpp"

namespace dermis::out::serve {

/// One of each array; none where nothing is limited. Fails, as "array 'chest': ...", where a limit does not fit one.
[[nodiscard]] Result<std::vector<live::threats::ThreatMonitor>> threat_monitors(const ServedSuit& suit);

/// The topic /threat of docs/stream.md and a line for the log of each threat. Thread-safe: each array on a thread of
/// its own.
class ThreatPublisher final : public Part {
 public:
  using Log = std::function<void(const std::string& line)>;

  /// The topic of all of them.
  [[nodiscard]] static Result<EventTopic> make_topic(Topics& topics, SuitRecorder& recorder);
  /// `monitors`: threat_monitors() of the suit, which has limits and must outlive it.
  ThreatPublisher(const ServedSuit& suit, std::vector<live::threats::ThreatMonitor> monitors, EventTopic topic,
                  Log log);

  /// "/threats/reset": latched threats end with the next frame of their array.
  [[nodiscard]] std::vector<websocket::Service> services() override;
  void hear(const live::suits::ArrayResult& result) override;
  /// Each threat that is there, as half a second ago or later.
  void diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const override;

 private:
  struct Watched {
    live::threats::ThreatMonitor monitor;
    const std::string& array;
    std::atomic<bool> is_reset_wanted = false;
    std::optional<Nanos> repeated{};  ///< When all limits were.
    std::optional<Nanos> logged{};    ///< When the last line was.
    std::vector<std::uint8_t> message{};
    mutable std::mutex standing_mutex{};
    std::vector<live::threats::ThreatState> standing{};  ///< The threats that are there.

    Watched(live::threats::ThreatMonitor its_monitor, const std::string& its_array)
        : monitor(std::move(its_monitor)), array(its_array) {}
  };

  void publish(Watched& watched, Nanos time, bool all);
  static void keep_standing(Watched& watched);
  void log(Watched& watched, const live::threats::ThreatState& state, Nanos time) const;
  void encode(Watched& watched, const live::threats::ThreatState& state, Nanos time) const;

  const live::threats::ThreatLimits& limits_;
  EventTopic topic_;
  Log log_;
  std::deque<Watched> arrays_;
};

/// A threat that is there, as a status of the array: what is exceeded by how much, since when.
[[nodiscard]] bytes::ros_messages::Diagnosis diagnosis_of(const std::string& array,
                                                          const live::threats::ThreatLimit& limit,
                                                          const live::threats::ThreatState& state);

/// The state in the words of a message.
[[nodiscard]] bytes::ros_messages::Threat::State state_of(const live::threats::ThreatLimit& limit,
                                                          const live::threats::ThreatState& state);

}  // namespace dermis::out::serve
