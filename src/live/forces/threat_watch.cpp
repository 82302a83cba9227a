// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/threat_watch.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <string>
#include <utility>

namespace dermis::live::forces {

using threats::ThreatPhase;
using threats::ThreatState;

ThreatWatch::ThreatWatch(Operation& operation, threats::ThreatMonitor monitor, const threats::ThreatLimits& limits,
                         std::atomic<bool>& stop, Log log)
    : operation_(operation),
      monitor_(std::move(monitor)),
      limits_(limits),
      stop_(stop),
      log_(std::move(log)),
      contacts_(operation.model.array, {}, operation.model.strip),
      troubles_(operation.model.array, operation.from),
      thread_([this] { run(); }) {}

ThreatWatch::~ThreatWatch() {
  stop_.store(true);
  thread_.join();
}

ThreatWatch::News ThreatWatch::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  over_.wait_for(lock, time, [this] { return news_.is_over; });
  return news_;
}

void ThreatWatch::run() noexcept {
  Status source = Done{};
  try {
    source = watch();
  } catch (const std::exception& error) {
    source = failed(std::string("watch: ") + error.what());
  }
  const std::lock_guard lock(mutex_);
  news_.source = std::move(source);
  news_.is_over = true;
  over_.notify_all();
}

Status ThreatWatch::watch() {
  while (!stop_.load()) {
    const Result<bool> more = operation_.frames->next(raw_);
    if (!more) return more.error();
    if (!*more) break;
    if (process()) {
      if (Status logged = log(); !logged) return logged;
    }
    if (is_over()) break;
  }
  return troubles_.verdict();
}

/// Whether a threat began or ended. Waiting callers hear of it before anything is written.
bool ThreatWatch::process() {
  operation_.pipeline.process(raw_, force_);
  troubles_.add(raw_, force_, operation_.pipeline, operation_.frames.get());
  contacts_.process(force_, report_);
  if (!first_time_) first_time_ = force_.time;
  const bool changes = monitor_.process(force_, report_);
  const bool has_begun = changes && begins();
  const bool has_forces =
      std::any_of(force_.newtons.begin(), force_.newtons.end(), [](float newtons) { return std::isfinite(newtons); });
  const std::lock_guard lock(mutex_);
  if (has_forces) {
    news_.has_begun = true;
    news_.last_frame = std::chrono::steady_clock::now();
  }
  news_.any_threat = news_.any_threat || has_begun;
  if (has_begun && operation_.frames->is_live()) {
    news_.is_over = true;
    over_.notify_all();
  }
  return changes;
}

bool ThreatWatch::begins() const {
  const std::span<const ThreatState> states = monitor_.states();
  return std::any_of(states.begin(), states.end(),
                     [](const ThreatState& state) { return state.changed && state.phase == ThreatPhase::standing; });
}

bool ThreatWatch::is_over() {
  const std::lock_guard lock(mutex_);
  return news_.is_over;
}

Status ThreatWatch::log() {
  std::vector<ThreatEvent> events;
  for (const ThreatState& state : monitor_.states()) {
    if (state.changed) events.push_back({limits_.limits[state.limit], state, force_.time, *first_time_});
  }
  return log_(events);
}

}  // namespace dermis::live::forces
