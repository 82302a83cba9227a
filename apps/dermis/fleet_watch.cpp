// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "child_process.hpp"
#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/robot_condition.hpp"
#include "fleet_connection.hpp"
#include "fleet_robots.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using live::fleet::RobotCondition;

constexpr int kExitAlarm = 3;
constexpr std::chrono::seconds kLookEvery{1};
constexpr std::chrono::milliseconds kLookAtCommandEvery{50};
constexpr std::chrono::seconds kLongestCommand{60};
constexpr int kLooksToAlarm = 2;  // a robot that is just beginning is no alarm
constexpr const char* kHubItself = "";
constexpr const char* kDiskOfHub = "/";  // no robot has such a name

struct WatchOptions {
  std::string hub;
  std::string command;
  bool is_once = false;
};

Nanos now() {
  return std::chrono::system_clock::now().time_since_epoch();
}

/// "anna is silent since 2026-11-28 05:00:00 UTC: nothing comes"
std::string sentence_of(const std::string& robot, const RobotCondition& condition) {
  std::string text = fmt::format("{}: {}", robot, live::fleet::to_string(condition.state));
  if (condition.since > Nanos{}) text += " since " + live::fleet::utc_text(condition.since);
  for (std::size_t k = 0; k < condition.reasons.size(); ++k) text += (k == 0 ? ": " : "; ") + condition.reasons[k];
  return text;
}

/// Sees who needs attention, and tells of each change once.
class Alarms {
 public:
  explicit Alarms(const WatchOptions& options) : options_(options) {}

  /// How many are new. `name` may be kHubItself.
  int take(const std::string& name, bool is_alarm, const std::string& sentence, RobotCondition::State state) {
    Seen& seen = seen_[name];
    const std::optional<RobotCondition::State> wanted = is_alarm ? std::optional(state) : std::nullopt;
    if (wanted == seen.told) {
      seen.looks = 0;
      return 0;
    }
    if (++seen.looks < kLooksToAlarm && is_alarm && !options_.is_once) return 0;
    seen.told = wanted;
    seen.looks = 0;
    tell(sentence);
    return is_alarm ? 1 : 0;
  }

 private:
  struct Seen {
    std::optional<RobotCondition::State> told{};  ///< Empty: it was well.
    int looks = 0;                                ///< It has been otherwise for so many.
  };

  void tell(const std::string& sentence) const {
    fmt::print("{}  {}\n", live::fleet::utc_text(now()), sentence);
    std::fflush(stdout);
    if (!options_.command.empty()) run(sentence);
  }

  /// The shell gets the sentence as "$1", so that nothing a robot says is taken for a command.
  void run(const std::string& sentence) const {
    Result<ChildProcess> child = ChildProcess::start({"/bin/sh", "-c", options_.command, "dermis", sentence});
    if (!child) return print_notice("--command: " + child.error().message);
    const auto end = std::chrono::steady_clock::now() + kLongestCommand;
    while (!child->exit_status() && std::chrono::steady_clock::now() < end && !stop_flag()) {
      std::this_thread::sleep_for(kLookAtCommandEvery);
    }
    const std::optional<int> status = child->exit_status();
    if (!status) return print_notice("--command: ended, as it took longer than a minute");
    if (*status != 0) print_notice(fmt::format("--command: ended with the exit status {}", *status));
  }

  const WatchOptions& options_;
  std::map<std::string, Seen> seen_{};
};

/// Returns how many alarms are new.
int look(live::fleet::Hub& hub, Alarms& alarms) {
  const Result<std::vector<live::fleet::RobotState>> robots = robots_seen_twice(hub);
  const std::string why = robots ? "the hub answers again" : "the hub does not answer: " + robots.error().message;
  int fresh = alarms.take(kHubItself, !robots, why, RobotCondition::State::silent);
  if (!robots) return fresh;
  const std::string full = hub.full_disk(*robots);
  fresh += alarms.take(kDiskOfHub, !full.empty(), full.empty() ? "the hub stores again" : full,
                       RobotCondition::State::error);
  for (const live::fleet::RobotState& robot : *robots) {
    const RobotCondition condition = live::fleet::condition_of(robot, now());
    fresh += alarms.take(robot.name, condition.needs_attention(), sentence_of(robot.name, condition), condition.state);
  }
  return fresh;
}

Result<int> watch(const WatchOptions& options) {
  const std::atomic<bool>& stop = stop_flag();
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  const Result<std::vector<live::fleet::RobotState>> robots = (*hub)->robots();
  if (!robots) return robots.error();
  if (robots->empty())
    return bad_input("the hub knows no robot that could be watched: dermis fleet add HUB --robot NAME");
  Alarms alarms(options);
  while (!stop) {
    const int fresh = look(**hub, alarms);
    if (options.is_once) return fresh > 0 ? kExitAlarm : 0;
    if (fresh > 0 && options.command.empty()) return kExitAlarm;
    std::this_thread::sleep_for(kLookEvery);
  }
  return 0;
}

}  // namespace

void add_fleet_watch(Command& fleet) {
  auto options = std::make_shared<WatchOptions>();
  Command command =
      fleet.subcommand("watch", "Wait until a robot is not well, say why, and end with the exit status 3");
  command.option("hub", options->hub, "nats://HOST of the hub").required();
  command.option("--command", options->command,
                 R"(Do not end: run this by sh for each alarm and each recovery, with the sentence as "$1")");
  command.flag("--once", options->is_once, "Look once: 0 where all are well");
  command.action_with_exit_status([options] { return watch(*options); });
}

}  // namespace dermis::app
