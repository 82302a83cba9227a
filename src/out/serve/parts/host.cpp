// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/parts/host.hpp"

#include <chrono>
#include <mutex>
#include <utility>

#include "out/serve/suit/suit_json.hpp"

namespace dermis::out::serve {
namespace {

constexpr int kInfoLevel = 0;
constexpr int kErrorLevel = 2;

}  // namespace

Status Host::use_model(std::size_t array, const std::shared_ptr<const touch::pipeline::Model>& model) {
  const std::lock_guard lock(*changing);
  if (Status used = live.set_model(array, model); !used) return used;
  models.replace(array, model);
  parts.model_changed(array);
  show_suit();
  server.parameters_changed();
  return Done{};
}

Status Host::use_classes(std::size_t array, learn::recognition::Classes classes) {
  const std::lock_guard lock(*changing);
  if (Status used = parts.use_classes(array, classes); !used) return used;
  suit.arrays[array].classes = std::move(classes);
  show_suit();
  return Done{};
}

void Host::show_suit() const {
  server.set_document("/suit.json", "application/json", suit_json(suit, models));
}

Nanos Host::now() const {
  if (suit.playback) return suit.playback->status().now;
  return std::chrono::steady_clock::now().time_since_epoch() + utc_minus_steady;
}

void Host::log(const std::string& line) const {
  if (options.server.notice) options.server.notice(line);
}

void Host::tell_error(const std::string& line) const {
  log(line);
  server.status(kErrorLevel, line);
}

void Host::notify(const std::string& line) const {
  log(line);
  server.status(kInfoLevel, line);
}

}  // namespace dermis::out::serve
