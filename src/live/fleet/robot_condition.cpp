// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/robot_condition.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <utility>

namespace dermis::live::fleet {
namespace {

using State = RobotCondition::State;
using Level = ArrayHealth::Level;

constexpr Nanos kBeginning = std::chrono::seconds(10);  // of a run
constexpr std::array<const char*, 7> kStates = {"silent",  "unreadable", "error", "behind",
                                                "warning", "no health",  "well"};

State state_of(const ArrayHealth& array) {
  if (array.level == Level::error) return State::error;
  const bool is_good = array.level == Level::good && !array.wants_calibration && array.refusal.empty();
  return is_good ? State::well : State::warning;
}

/// A robot that is well in what it says.
void judge_arrays(const RobotHealth& health, RobotCondition& condition) {
  for (const ArrayHealth& array : health.arrays) {
    const State state = state_of(array);
    if (state == State::well || state > condition.state) continue;
    const Nanos since = array.refusal.empty() || array.level == Level::error ? array.since : array.refused;
    condition.since = state == condition.state ? std::min(condition.since, since) : since;
    condition.state = state;
  }
  if (health.has_little_space()) condition.state = std::min(condition.state, State::warning);
  if (health.is_doubled) condition.state = std::min(condition.state, State::error);
}

void add_reasons_of(const ArrayHealth& array, std::vector<std::string>& reasons) {
  const auto add = [&](const std::string& what) { reasons.push_back(array.name + ": " + what); };
  if (array.level != Level::good && !array.message.empty()) add(array.message);
  if (!array.refusal.empty()) add(model_use(array));
  const bool says_so = array.level != Level::good && array.message.find("calibrate") != std::string::npos;
  if (array.wants_calibration && !says_so) add("calibrate");
  if (array.left_out > 0)
    add(fmt::format("{} frames were not published, as its server did not follow", array.left_out));
  if (array.damaged > 0) add(fmt::format("{} frames came damaged", array.damaged));
  if (array.late > 0) add(fmt::format("{} frames were late", array.late));
}

void add_reasons_of(const RobotHealth& health, std::vector<std::string>& reasons) {
  if (health.is_doubled) reasons.emplace_back("another robot publishes under this name; rename one of them");
  if (health.has_little_space()) {
    reasons.push_back(fmt::format("its disk has {:.2f} GB left", static_cast<double>(*health.free_bytes) / 1e9));
  }
  for (const ArrayHealth& array : health.arrays) add_reasons_of(array, reasons);
}

/// "no message for 12 s"
std::string silence_text(const RobotState& robot, Nanos now) {
  const Nanos last = std::max(robot.last, robot.health_time);
  return fmt::format("no message for {} s", std::chrono::duration_cast<std::chrono::seconds>(now - last).count());
}

/// The condition of a robot that does not tell how it is now.
RobotCondition silence_of(const RobotState& robot, Nanos now) {
  if (robot.health_time > now) {
    return {State::silent, {}, {"its clock is ahead of this one; set both by NTP"}};
  }
  if (robot.lag > 0) {
    return {State::behind, robot.health_time, {fmt::format("the hub still lacks {} of its messages", robot.lag)}};
  }
  if (robot.comes && robot.health_time > Nanos{}) {
    const auto late = std::chrono::duration_cast<std::chrono::seconds>(now - robot.health_time).count();
    return {State::behind, robot.health_time, {fmt::format("its messages reach the hub {} s late", late)}};
  }
  if (robot.messages == 0) return {State::silent, {}, {"the hub has nothing of it yet"}};
  if (robot.health_time == Nanos{}) return {State::no_health, {}, {"it has not told how it is"}};
  return {State::silent,
          robot.health_time,
          {silence_text(robot, now) + ": look whether it is on, publishes and reaches the hub"}};
}

std::string level_words(const ArrayHealth& array) {
  switch (array.level) {
    case Level::good: return "well";
    case Level::warning: return "warning: " + (array.message.empty() ? "see its model" : array.message);
    case Level::error: return "error: " + array.message;
    case Level::ended: return "ended: " + array.message;
  }
  return "";
}

void add_changes_of(const ArrayHealth* before, const ArrayHealth& after, std::vector<std::string>& changes) {
  const auto add = [&](const std::string& what) { changes.push_back(after.name + ": " + what); };
  const ArrayHealth none{.name = after.name};
  const ArrayHealth& old = before != nullptr ? *before : none;
  const bool is_new = old.level != after.level || (after.level != Level::good && old.message != after.message);
  const bool is_refusal_alone = after.level == Level::warning && after.message.empty();
  if (is_new && !is_refusal_alone) add(level_words(after));
  if (old.used_model != after.used_model && after.used_model > 0) {
    add(fmt::format("model {} of the fleet is in use", after.used_model));
  }
  if (old.refusal != after.refusal && !after.refusal.empty()) {
    add(fmt::format("model {} is refused: {}", after.wanted_model, after.refusal));
  }
}

}  // namespace

const char* to_string(RobotCondition::State state) {
  return kStates[static_cast<std::size_t>(state)];
}

std::string utc_text(Nanos time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time).count();
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

std::string model_use(const ArrayHealth& array) {
  if (array.wanted_model == 0 && array.used_model == 0) return "";
  const std::string used = array.used_model > 0 ? std::to_string(array.used_model) : "its own";
  if (array.refusal.empty() && array.used_model == array.wanted_model) return fmt::format("model {} in use", used);
  std::string both = fmt::format("model {} wanted, {} in use", array.wanted_model, used);
  if (array.refusal.empty()) return both;
  return fmt::format("{}: refused since {}: {}", both, utc_text(array.refused), array.refusal);
}

RobotCondition condition_of(const RobotState& robot, Nanos now) {
  if (!robot.health_error.empty()) return {State::unreadable, robot.health_time, {robot.health_error}};
  const bool is_silent = robot.is_silent(now);
  RobotCondition condition = is_silent ? silence_of(robot, now) : RobotCondition{};
  if (!robot.health) return condition;
  if (!is_silent && robot.is_stale(now)) condition.reasons.push_back(silence_text(robot, now));
  if (!is_silent) judge_arrays(*robot.health, condition);
  if (!is_silent) add_reasons_of(*robot.health, condition.reasons);
  return condition;
}

std::vector<std::string> changes_between(const RobotHealth* before, const RobotHealth& after) {
  std::vector<std::string> changes;
  const bool is_new_run = before == nullptr || before->begun != after.begun;
  if (is_new_run && after.time - after.begun < kBeginning) {
    const bool was_silent = after.before > Nanos{} && after.begun - after.before > kSilentAfter;
    const std::string silence = !was_silent ? "" : "; it was silent since " + utc_text(after.before);
    changes.push_back("begins to publish" + silence);
  }
  const bool was_doubled = before != nullptr && before->is_doubled;
  if (after.is_doubled && !was_doubled) changes.emplace_back("another robot publishes under this name");
  if (after.has_little_space() && (before == nullptr || !before->has_little_space())) {
    changes.emplace_back("its disk is nearly full");
  }
  for (const ArrayHealth& array : after.arrays) {
    const ArrayHealth* old = nullptr;
    if (before != nullptr && !is_new_run) {
      const auto found = std::find_if(before->arrays.begin(), before->arrays.end(),
                                      [&](const ArrayHealth& one) { return one.name == array.name; });
      if (found != before->arrays.end()) old = &*found;
    }
    add_changes_of(old, array, changes);
  }
  return changes;
}

}  // namespace dermis::live::fleet
