// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/health/tares.hpp"

#include <fmt/chrono.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace dermis::serve {
namespace {

constexpr std::chrono::minutes kUndoFor{1};
constexpr std::string_view kTare = "/tare";

}  // namespace

Tares::Tares(const ServedSuit& suit, live::LiveSuit& live) : suit_(suit), live_(live), zeros_(suit.arrays.size()) {}

std::vector<stream::Parameter> Tares::parameters() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> refusals;
  for (const Zero& zero : zeros_) {
    if (!zero.refusal.empty()) refusals.push_back(zero.refusal);
  }
  const bool all_tared = std::all_of(zeros_.begin(), zeros_.end(), [](const Zero& zero) { return zero.is_tared; });
  std::vector<stream::Parameter> all = {{"/tare", all_tared},
                                        {"/tare/force", false},
                                        {"/tare/undo", std::any_of(zeros_.begin(), zeros_.end(), can_be_undone)},
                                        {"/tare/refused", fmt::format("{}", fmt::join(refusals, "; "))},
                                        {"/tare/log", fmt::format("{}", fmt::join(log_, "\n"))}};
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    all.push_back({"/" + suit_.arrays[k].name + "/tare", zeros_[k].is_tared});
  }
  return all;
}

bool Tares::set(const std::string& name, bool value, const std::string& client) {
  const std::lock_guard lock(mutex_);
  if (name == "/tare/force") {
    force(client);
  } else if (name == "/tare/undo") {
    undo(client);
  } else {
    if (!name.ends_with(kTare)) return false;
    const std::vector<std::size_t> arrays = arrays_of(name.substr(0, name.size() - kTare.size()));
    for (const std::size_t k : arrays) value ? tare(k, pipeline::TareOver::drift, client) : reset(k, client);
    return !arrays.empty();
  }
  return true;
}

/// Of "/chest" that one, of "" all.
std::vector<std::size_t> Tares::arrays_of(const std::string& prefix) const {
  std::vector<std::size_t> arrays;
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    if (prefix.empty() || prefix == "/" + suit_.arrays[k].name) arrays.push_back(k);
  }
  return arrays;
}

void Tares::tare(std::size_t array, pipeline::TareOver over, const std::string& client) {
  live_.tare(array, over);
  Zero& zero = zeros_[array];
  zero.was_tared = std::exchange(zero.is_tared, true);
  zero.client = client;
  zero.refusal.clear();
}

/// Those that were refused; all, where none was.
void Tares::force(const std::string& client) {
  const auto is_refused = [](const Zero& zero) { return !zero.refusal.empty(); };
  const bool is_any = std::any_of(zeros_.begin(), zeros_.end(), is_refused);
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    if (!is_any || is_refused(zeros_[k])) tare(k, pipeline::TareOver::any_load, client);
  }
}

void Tares::reset(std::size_t array, const std::string& client) {
  live_.reset_tare(array);
  const std::uint64_t seen = zeros_[array].seen;
  zeros_[array] = {};
  zeros_[array].seen = seen;
  log(fmt::format("{} got back the zero of its calibration by {}", suit_.arrays[array].name, client));
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
    log(fmt::format("{} got back the zero before its tare by {}", suit_.arrays[k].name, client));
  }
}

std::vector<std::string> Tares::follow() {
  for (std::size_t k = 0; k < zeros_.size(); ++k) {
    const pipeline::Tare tare = live_.statistics(k).tare;
    const std::lock_guard lock(mutex_);
    const bool is_news = tare.has_ended() && tare.number != zeros_[k].seen;
    zeros_[k].seen = tare.has_ended() ? tare.number : 0;
    if (is_news && !zeros_[k].client.empty()) end(k, tare);
  }
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

void Tares::end(std::size_t array, const pipeline::Tare& tare) {
  Zero& zero = zeros_[array];
  const std::string& name = suit_.arrays[array].name;
  const std::string load = pipeline::describe(tare, suit_.arrays[array].model->array);
  if (tare.state == pipeline::Tare::State::refused) {
    zero.is_tared = zero.was_tared;
    zero.refusal = fmt::format("{}: {}", name, load);
    log(fmt::format("{} was not tared, as {} asked: {}", name, zero.client, load));
  } else {
    zero.taken = Clock::now();
    log(fmt::format("{} was tared by {}{}{}", name, zero.client, load.empty() ? "" : ": ", load));
  }
  zero.client.clear();
}

void Tares::log(const std::string& what) {
  const std::time_t now = Clock::to_time_t(Clock::now());
  std::string line = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC: {}", fmt::gmtime(now), what);
  log_.push_front(line);
  if (log_.size() > kMostLines) log_.pop_back();
  news_.push_back(std::move(line));
}

void Tares::forget(std::size_t array) {
  const std::lock_guard lock(mutex_);
  zeros_[array] = {};
}

}  // namespace dermis::serve
