// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/fleet/robot_health.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

class Broker;

/// A robot whose health is older does not talk to the hub.
inline constexpr Nanos kSilentAfter = std::chrono::seconds(10);
/// Rates in a health that is older are not shown: it comes once a second.
inline constexpr Nanos kStaleAfter = std::chrono::seconds(3);

/// The frames of a robot on the hub, and how it is.
struct RobotState {
  std::string name;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  Nanos last{};           ///< The last message arrived then at the robot's server, by UTC; 0: none did.
  std::uint64_t lag = 0;  ///< Messages that the robot's server has and the hub not yet, as far as the hub knows.

  bool comes = false;  ///< The hub has got messages of it in the last seconds, as far as it was asked before.

  std::optional<RobotHealth> health{};  ///< The last that it told; empty: none that can be read,
  std::string health_error{};           ///< and why not.
  Nanos health_time{};                  ///< It arrived then at the robot's server, by UTC; 0: none did.

  /// It does not tell how it is, or its clock is far from that of the hub.
  [[nodiscard]] bool is_silent(Nanos now) const noexcept {
    return health_time + kSilentAfter < now || now + kSilentAfter < health_time;
  }
  /// Its last health may not be so any more.
  [[nodiscard]] bool is_stale(Nanos now) const noexcept {
    return is_silent(now) || (health_time + kStaleAfter < now && !comes);
  }
};

/// A change in the way a robot was.
struct RobotEvent {
  Nanos time{};  ///< By UTC.
  std::string robot;
  std::string text;  ///< "chest: warning: 2 faults"
};

/// All robots of a hub at one moment.
struct FleetState {
  std::string hub;      ///< Its address, as it may be shown.
  std::string error{};  ///< Why the hub does not answer; empty: it does.
  std::vector<RobotState> robots{};
  std::string full{};  ///< As Hub::full_disk().
};

/// For a page: the names of RobotState and ArrayHealth, and ages at `now` in seconds.
[[nodiscard]] std::string fleet_to_json(const FleetState& fleet, Nanos now);

/// For a page: times in milliseconds since 1970.
[[nodiscard]] std::string history_to_json(const std::vector<RobotEvent>& events);

/// The server that has copies of the streams of all robots. Thread-safe.
class Hub {
 public:
  /// Fails where the plugin is not there, and where no server answers.
  [[nodiscard]] static Result<std::unique_ptr<Hub>> connect(const BrokerAddress& address);
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;
  ~Hub();

  /// Makes the place where robots behind their own servers claim their names. One that is there stays.
  [[nodiscard]] Status prepare();
  /// From now on the hub copies all that the robot's server has and gets. A robot that is there stays.
  [[nodiscard]] Status add_robot(const std::string& name);
  [[nodiscard]] Result<std::vector<RobotState>> robots();
  /// Says in a sentence that the hub's disk is full, and how much it holds; empty: it stores, or does not answer. Asks
  /// the hub only where one of these robots is stale.
  [[nodiscard]] std::string full_disk(const std::vector<RobotState>& robots);
  /// Changes of these robots since a time, the newest last.
  [[nodiscard]] Result<std::vector<RobotEvent>> history(const std::vector<RobotState>& robots, Nanos since);

 private:
  explicit Hub(std::unique_ptr<Broker> broker);
  void add_health(RobotState& robot);
  [[nodiscard]] Status add_events(const RobotState& robot, Nanos since, std::vector<RobotEvent>& events);

  void see_growth(RobotState& robot);

  /// How many messages of a robot were there, and when there were more than before.
  struct Growth {
    std::uint64_t messages = 0;
    std::chrono::steady_clock::time_point last{};
  };

  std::unique_ptr<Broker> broker_;
  std::mutex mutex_;
  std::map<std::string, Growth> growths_{};  ///< By name; guarded by `mutex_`.
};

}  // namespace dermis::live::fleet
