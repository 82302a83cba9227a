// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/tares.hpp"

#include <fmt/chrono.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "out/serve/parts/part_makers.hpp"
#include "out/serve/topics/mark_book.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::chrono::minutes kUndoFor{1};
constexpr std::chrono::minutes kRefusedFor{1};

}  // namespace

Tares::Tares(const ServedSuit& suit, live::suits::LiveSuit& live, Notify notify, Changed changed)
    : suit_(suit), live_(live), notify_(std::move(notify)), changed_(std::move(changed)), zeros_(suit.arrays.size()) {
  for (const ServedArray& array : suit.arrays) kept_.emplace_back(suit, array);
}

Status Tares::prepare() {
  const std::lock_guard lock(mutex_);
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    std::vector<double> offsets = kept_[k].read();
    if (offsets.empty()) continue;
    live_.use_zero(k, std::move(offsets));
    zeros_[k].is_tared = true;
    log(fmt::format("{} has its zero of {}", suit_.arrays[k].name, kept_[k].taken_at()));
  }
  return Done{};
}

std::vector<LiveParameter> Tares::parameters() {
  const auto locked = [this](auto value) {
    return [this, value]() -> websocket::ParameterValue {
      const std::lock_guard lock(mutex_);
      return value();
    };
  };
  const auto command = [this](void (Tares::*run)(const std::string&)) {
    return [this, run](bool, const std::string& client) -> Status {
      const std::lock_guard lock(mutex_);
      (this->*run)(client);
      return Done{};
    };
  };
  std::vector<LiveParameter> all = {
      tare_of("/tare", 0, zeros_.size()),
      {.name = "/tare/force", .value = [] { return false; }, .set_switch = command(&Tares::force)},
      {.name = "/tare/undo",
       .value = locked([this] { return std::any_of(zeros_.begin(), zeros_.end(), can_be_undone); }),
       .set_switch = command(&Tares::undo)},
      {.name = "/tare/taken", .value = locked([this] { return std::all_of(zeros_.begin(), zeros_.end(), is_taken); })},
      {.name = "/tare/refused", .value = locked([this] { return refusals(); })},
      {.name = "/tare/log", .value = locked([this] { return fmt::format("{}", fmt::join(log_, "\n")); })}};
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    all.push_back(tare_of("/" + suit_.arrays[k].name + "/tare", k, k + 1));
  }
  return all;
}

/// Controls the arrays [first, end): on where all of them are tared.
LiveParameter Tares::tare_of(const std::string& name, std::size_t first, std::size_t end) {
  const auto value = [this, first, end] {
    const std::lock_guard lock(mutex_);
    for (std::size_t k = first; k < end; ++k) {
      if (!zeros_[k].is_tared) return false;
    }
    return true;
  };
  const auto set = [this, first, end](bool on, const std::string& client) -> Status {
    const std::lock_guard lock(mutex_);
    for (std::size_t k = first; k < end; ++k) on ? tare(k, touch::pipeline::TareOver::drift, client) : reset(k, client);
    return Done{};
  };
  return {.name = name, .value = value, .set_switch = set};
}

std::string Tares::refusals() const {
  std::vector<std::string> refusals;
  for (const Zero& zero : zeros_) {
    if (!zero.refusal.empty() && Clock::now() - zero.refused <= kRefusedFor) refusals.push_back(zero.refusal);
  }
  return fmt::format("{}", fmt::join(refusals, "; "));
}

void Tares::tare(std::size_t array, touch::pipeline::TareOver over, const std::string& client) {
  live_.tare(array, over);
  Zero& zero = zeros_[array];
  zero.was_tared = std::exchange(zero.is_tared, true);
  zero.client = client;
  zero.refusal.clear();
}

/// The arrays whose tare was refused; all where none was.
void Tares::force(const std::string& client) {
  const auto is_refused = [](const Zero& zero) { return !zero.refusal.empty(); };
  const bool is_any = std::any_of(zeros_.begin(), zeros_.end(), is_refused);
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    if (!is_any || is_refused(zeros_[k])) tare(k, touch::pipeline::TareOver::any_load, client);
  }
}

void Tares::reset(std::size_t array, const std::string& client) {
  live_.reset_tare(array);
  const std::uint64_t seen = zeros_[array].seen;
  zeros_[array] = {};
  zeros_[array].seen = seen;
  kept_[array].remove();
  log(fmt::format("{} got back the zero of its calibration by {}", suit_.arrays[array].name, client));
}

bool Tares::is_taken(const Zero& zero) {
  return zero.is_tared && zero.client.empty();
}

bool Tares::can_be_undone(const Zero& zero) {
  return zero.taken && Clock::now() - *zero.taken <= kUndoFor;
}

void Tares::undo(const std::string& client) {
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    Zero& zero = zeros_[k];
    if (!can_be_undone(zero)) continue;
    live_.undo_tare(k);
    zero.is_tared = zero.was_tared;
    zero.taken.reset();
    kept_[k].remove();
    log(fmt::format("{} got back the zero before its tare by {}", suit_.arrays[k].name, client));
  }
}

std::vector<std::string> Tares::follow() {
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    const touch::pipeline::Tare tare = live_.statistics(k).tare;
    const std::lock_guard lock(mutex_);
    const bool is_news = tare.has_ended() && tare.number != zeros_[k].seen;
    zeros_[k].seen = tare.has_ended() ? tare.number : 0;
    if (is_news && !zeros_[k].client.empty()) end(k, tare);
  }
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

void Tares::end(std::size_t array, const touch::pipeline::Tare& tare) {
  Zero& zero = zeros_[array];
  const std::string& name = suit_.arrays[array].name;
  const std::string load = touch::pipeline::describe(tare, suit_.arrays[array].model->array);
  if (tare.state == touch::pipeline::Tare::State::refused) {
    zero.is_tared = zero.was_tared;
    zero.refusal = fmt::format("{}: {}", name, load);
    zero.refused = Clock::now();
    log(fmt::format("{} was not tared, as {} asked: {}", name, zero.client, load), Outcome::refused);
  } else {
    zero.taken = Clock::now();
    log(fmt::format("{} was tared by {}{}{}", name, zero.client, load.empty() ? "" : ": ", load));
    if (Status kept = kept_[array].write(live_.zero(array)); !kept) {
      log(fmt::format("the zero of {} is not kept: {}", name, kept.error().message));
    }
  }
  zero.client.clear();
}

void Tares::log(const std::string& what, Outcome outcome) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::string line = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC: {}", fmt::gmtime(now), what);
  log_.push_front(line);
  if (log_.size() > kMostLines) log_.pop_back();
  if (changed_ && outcome == Outcome::changed) changed_(line);
  news_.push_back(std::move(line));
}

void Tares::tick(std::int64_t /*tick*/) {
  const std::vector<std::string> news = follow();
  if (notify_ && !news.empty()) notify_(news);
}

void Tares::model_changed(std::size_t array) {
  const std::lock_guard lock(mutex_);
  zeros_[array] = {};
  kept_[array].remove();
}

Result<std::unique_ptr<Part>> make_tares(Host& host) {
  const auto notify = [&host](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) host.notify(line);
    host.server.parameters_changed();
  };
  const auto changed = [&host](const std::string& line) {
    host.marks.add({.time = host.now(), .label = line, .event = "tare"}, host.now());
  };
  return std::unique_ptr<Part>(std::make_unique<Tares>(host.suit, host.live, notify, changed));
}

}  // namespace dermis::out::serve
