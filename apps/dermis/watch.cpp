// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "child_process.hpp"
#include "commands.hpp"
#include "dermis/fusion/contact.hpp"
#include "dermis/threats/threat_limits.hpp"
#include "dermis/threats/threat_monitor.hpp"
#include "open_source.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using Clock = std::chrono::steady_clock;
using threats::ThreatPhase;
using threats::ThreatState;
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

/// A threat that has begun or ended, for the log.
struct LogEntry {
  const threats::ThreatLimit& limit;
  const ThreatState& state;
  Nanos time;
  Nanos first_time;  // of the source

  [[nodiscard]] bool begins() const { return state.phase == ThreatPhase::standing; }
  [[nodiscard]] const std::string& quantity() const {
    return threats::threat_quantity_names()[static_cast<std::size_t>(limit.quantity)];
  }
};

std::string line_of(const LogEntry& entry) {
  const double seconds = std::chrono::duration<double>(entry.time - entry.first_time).count();
  if (!entry.begins()) return fmt::format("{:10.3f} s  {} ends", seconds, entry.limit.name);
  const double crossed = std::chrono::duration<double>(entry.state.crossed - entry.first_time).count();
  return fmt::format("{:10.3f} s  {} begins: {}, crossed at {:.3f} s", seconds, entry.limit.name,
                     threats::describe(entry.limit, entry.state.now), crossed);
}

std::string json_of(const LogEntry& entry) {
  const threats::ThreatValue& value = entry.state.now;
  const Json json = {{"threat", entry.limit.name},    {"event", entry.begins() ? "begins" : "ends"},
                     {"time_ns", entry.time.count()}, {"crossed_ns", entry.state.crossed.count()},
                     {"quantity", entry.quantity()},  {"value", value.value},
                     {"sigma", value.sigma},          {"unit", threats::unit_of(entry.limit.quantity)},
                     {"limit", entry.limit.limit},    {"x_m", value.position.x},
                     {"y_m", value.position.y},       {"contact", value.contact}};
  return json.dump();
}

/// Reads frames on a thread of its own, so that silence and the end of the program are seen while none comes.
class Watcher {
 public:
  Watcher(Operation& operation, threats::ThreatMonitor monitor, const threats::ThreatLimits& limits, bool json)
      : operation_(operation),
        monitor_(std::move(monitor)),
        limits_(limits),
        json_(json),
        contacts_(operation.model.array, {}, operation.model.strip),
        thread_([this] { run(); }) {}
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;
  ~Watcher() {
    stop_flag().store(true);
    thread_.join();
  }

  struct News {
    bool has_begun = false;  // a frame with forces has come
    bool is_over = false;    // the source has ended, failed or, where it is live, shown a threat
    bool any_threat = false;
    Clock::time_point last_frame{};  // with forces
    Status source = Done{};
  };

  /// Waits until it is over, or for `time`.
  News wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    over_.wait_for(lock, time, [this] { return news_.is_over; });
    return news_;
  }

 private:
  void run() noexcept {
    Status source = Done{};
    try {
      source = watch();
    } catch (const std::exception& error) {
      source = failed(fmt::format("watch: {}", error.what()));
    }
    const std::lock_guard lock(mutex_);
    news_.source = std::move(source);
    news_.is_over = true;
    over_.notify_all();
  }

  Status watch() {
    while (!stop_flag().load()) {
      const Result<bool> more = operation_.frames->next(raw_);
      if (!more) return more.error();
      if (!*more) break;
      if (process()) {
        if (Status logged = log(); !logged) return logged;
      }
      if (is_over()) break;
    }
    return Done{};
  }

  /// Whether a threat began or ended. Who waits is told before anything is written.
  bool process() {
    operation_.pipeline.process(raw_, force_);
    contacts_.process(force_, report_);
    if (!first_time_) first_time_ = force_.time;
    const bool changes = monitor_.process(force_, report_);
    const std::span<const ThreatState> states = monitor_.states();
    const bool begins = changes && std::any_of(states.begin(), states.end(), [](const ThreatState& state) {
                          return state.changed && state.phase == ThreatPhase::standing;
                        });
    const bool has_forces =
        std::any_of(force_.newtons.begin(), force_.newtons.end(), [](float newtons) { return std::isfinite(newtons); });
    const std::lock_guard lock(mutex_);
    if (has_forces) {
      news_.has_begun = true;
      news_.last_frame = Clock::now();
    }
    news_.any_threat = news_.any_threat || begins;
    if (begins && operation_.frames->is_live()) {
      news_.is_over = true;
      over_.notify_all();
    }
    return changes;
  }

  [[nodiscard]] bool is_over() {
    const std::lock_guard lock(mutex_);
    return news_.is_over;
  }

  Status log() {
    for (const ThreatState& state : monitor_.states()) {
      if (!state.changed) continue;
      const LogEntry entry{limits_.limits[state.limit], state, force_.time, *first_time_};
      fmt::print("{}\n", json_ ? json_of(entry) : line_of(entry));
    }
    if (std::fflush(stdout) != 0) {
      return failed(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
    }
    return Done{};
  }

  Operation& operation_;
  threats::ThreatMonitor monitor_;
  const threats::ThreatLimits& limits_;
  const bool json_;
  fusion::ContactTracker contacts_;
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
  std::optional<Nanos> first_time_;
  std::mutex mutex_;
  std::condition_variable over_;
  News news_;
  std::thread thread_;  // the last: it uses all others
};

/// Starts the program with the first frame and stops it with the watch.
Result<int> keep_watch(Watcher& watcher, bool is_live, const std::vector<std::string>& command) {
  std::optional<ChildProcess> child;
  for (;;) {
    const Watcher::News news = watcher.wait(kLook);
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
void tell_unwatched(const threats::ThreatLimits& limits, const std::string& array) {
  for (const threats::ThreatLimit& limit : limits.limits) {
    if (limit.zone.empty() || limits.zone(limit.zone)->array == array) continue;
    say(fmt::format("'{}' is for '{}' and is not watched on '{}'", limit.name, limits.zone(limit.zone)->array, array));
  }
}

Result<int> watch(const WatchOptions& options) {
  const Result<threats::ThreatLimits> limits = threats::read_threat_limits(options.threats);
  if (!limits) return limits.error();
  const Result<std::unique_ptr<Operation>> operation = open_operation(options.model, options.in);
  if (!operation) return operation.error();
  const ArrayDescription& array = (*operation)->model.array;
  Result<threats::ThreatMonitor> monitor = threats::ThreatMonitor::create(*limits, array.name, array);
  if (!monitor) return bad_input(fmt::format("{}: {}", options.threats, monitor.error().message));
  if (monitor->states().empty()) {
    return bad_input(
        fmt::format("{}: no threat is for '{}'; its zones are of other arrays", options.threats, array.name));
  }
  tell_unwatched(*limits, array.name);
  const bool is_live = (*operation)->frames->is_live();
  if (!is_live && !options.command.empty())
    return bad_input("a program can be watched with a device alone, not a file");
  Watcher watcher(**operation, std::move(*monitor), *limits, options.json);
  return keep_watch(watcher, is_live, options.command);
}

}  // namespace

void add_watch(Command& command) {
  auto options = std::make_shared<WatchOptions>();
  command.option("--threats", options->threats, "threats.toml: what must not be exceeded").required();
  command.option("--model", options->model, "Model file of 'dermis calibrate', or array.toml where readings are forces")
      .required();
  command.option("--in", options->in, "Raw counts: the URI of a device; a file is read to its end").required();
  command.flag("--json", options->json, "Write threats as JSON lines");
  command.option("command", options->command,
                 "After --: a program that runs while no threat stands; SIGTERM stops it. The exit status is 3 after a "
                 "threat, 1 where frames fail or stay away for 1 s, else that of the program. No safety function");
  command.action_with_exit_status([options] { return watch(*options); });
}

}  // namespace dermis::app
