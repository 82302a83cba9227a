// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "child_process.hpp"
#include "commands.hpp"
#include "dermis/live/forces/operation.hpp"
#include "dermis/live/forces/threat_watch.hpp"
#include "dermis/live/threats/threat_limits.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "source_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using Clock = std::chrono::steady_clock;
using live::forces::Operation;
using live::forces::ThreatEvent;
using live::forces::ThreatWatch;
using Json = nlohmann::ordered_json;

constexpr int kExitThreat = 3;
constexpr std::chrono::seconds kMostSilence{1};
constexpr std::chrono::milliseconds kLook{20};

struct WatchOptions {
  std::string threats;
  std::string model;
  std::string in;
  bool json = false;
  std::vector<std::string> command;
};

std::string line_of(const ThreatEvent& event) {
  const double seconds = std::chrono::duration<double>(event.time - event.first_time).count();
  if (!event.begins()) return fmt::format("{:10.3f} s  {} ends", seconds, event.limit.name);
  const double crossed = std::chrono::duration<double>(event.state.crossed - event.first_time).count();
  return fmt::format("{:10.3f} s  {} begins: {}, crossed at {:.3f} s", seconds, event.limit.name,
                     live::threats::describe(event.limit, event.state.now), crossed);
}

std::string json_of(const ThreatEvent& event) {
  const live::threats::ThreatValue& value = event.state.now;
  const Json json = {
      {"threat", event.limit.name},
      {"event", event.begins() ? "begins" : "ends"},
      {"time_ns", event.time.count()},
      {"crossed_ns", event.state.crossed.count()},
      {"quantity", live::threats::threat_quantity_names()[static_cast<std::size_t>(event.limit.quantity)]},
      {"value", value.value},
      {"sigma", value.sigma},
      {"unit", live::threats::unit_of(event.limit.quantity)},
      {"limit", event.limit.limit},
      {"x_m", value.position.x},
      {"y_m", value.position.y},
      {"contact", value.contact}};
  return json.dump();
}

Status print(const std::vector<ThreatEvent>& events, bool json) {
  for (const ThreatEvent& event : events) fmt::print("{}\n", json ? json_of(event) : line_of(event));
  if (std::fflush(stdout) != 0) {
    return cannot_print(errno);
  }
  return Done{};
}

/// Starts the program with the first frame and stops it with the watch.
Result<int> keep_watch(ThreatWatch& watch, bool is_live, const std::vector<std::string>& command) {
  std::optional<ChildProcess> child;
  for (;;) {
    const ThreatWatch::News news = watch.wait(kLook);
    if (news.is_over) {
      child.reset();
      if (news.any_threat) return kExitThreat;
      if (!news.source) return news.source.error();
      if (!command.empty() && !stop_flag().load()) return failed("the source has ended: nothing is watched any more");
      return 0;
    }
    if (child && child->exit_status()) return *child->exit_status();
    if (!news.has_begun) continue;
    if (is_live && Clock::now() - news.last_frame > kMostSilence) {
      return failed("no frame with forces for 1 s: nothing is watched any more");
    }
    if (command.empty() || child) continue;
    Result<ChildProcess> started = ChildProcess::start(command);
    if (!started) return started.error();
    child.emplace(std::move(*started));
  }
}

/// Limits for zones of arrays of another name, which may be misspelt.
void tell_unwatched(const live::threats::ThreatLimits& limits, const std::string& array) {
  for (const live::threats::ThreatLimit& limit : limits.limits) {
    if (limit.zone.empty() || limits.zone(limit.zone)->array == array) continue;
    print_notice(
        fmt::format("'{}' is for '{}' and is not watched on '{}'", limit.name, limits.zone(limit.zone)->array, array));
  }
}

Result<int> watch(const WatchOptions& options) {
  const Result<live::threats::ThreatLimits> limits = live::threats::read_threat_limits(options.threats);
  if (!limits) return limits.error();
  const Result<std::unique_ptr<Operation>> operation =
      live::forces::open_operation(options.model, options.in, source_options());
  if (!operation) return operation.error();
  const ArrayDescription& array = (*operation)->model.array;
  Result<live::threats::ThreatMonitor> monitor = live::threats::ThreatMonitor::create(*limits, array.name, array);
  if (!monitor) return bad_input(fmt::format("{}: {}", options.threats, monitor.error().message));
  if (monitor->states().empty()) {
    return bad_input(
        fmt::format("{}: no threat is for '{}'; its zones are of other arrays", options.threats, array.name));
  }
  tell_unwatched(*limits, array.name);
  const bool is_live = (*operation)->frames->is_live();
  if (!is_live && !options.command.empty())
    return bad_input("a program can be watched with a device alone, not a file");
  ThreatWatch watch(**operation, *std::move(monitor), *limits, stop_flag(),
                    [&](const std::vector<ThreatEvent>& events) { return print(events, options.json); });
  return keep_watch(watch, is_live, options.command);
}

}  // namespace

void add_watch(Command& command) {
  auto options = std::make_shared<WatchOptions>();
  command.input("--threats", options->threats, "threats.toml: the limits").required();
  command
      .input_file("--model", options->model,
                  "Model file of 'dermis calibrate', or array.toml where readings are forces")
      .required();
  command.input("--in", options->in, "Raw counts: the URI of a device; a file is read to its end").required();
  command.flag("--json", options->json, "Write threats as JSON lines");
  command.option(
      "command", options->command,
      "After --: a program that runs until a threat begins; SIGTERM stops it. The exit status is 3 after a threat, "
      "1 if frames fail or stop coming for 1 s, else that of the program. No safety function");
  command.action_with_exit_status([options] { return watch(*options); });
}

}  // namespace dermis::app
