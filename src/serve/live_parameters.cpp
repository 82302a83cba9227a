// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/live_parameters.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

namespace dermis::serve {
namespace {

constexpr double kSlowestStreamHz = 1.0;
constexpr double kFastestStreamHz = 1000.0;
constexpr std::string_view kTare = "/tare";

}  // namespace

LiveParameters::LiveParameters(const ServedSuit& suit, live::LiveSuit& live, Broadcaster& broadcaster,
                               SuitRecorder& recorder)
    : suit_(suit), live_(live), broadcaster_(broadcaster), recorder_(recorder), tared_(suit.arrays.size()) {}

std::vector<stream::Parameter> LiveParameters::all() const {
  const live::LiveSettings settings = live_.settings();
  const bool all_tared = std::all_of(tared_.begin(), tared_.end(), [](const auto& tared) { return tared.load(); });
  std::vector<stream::Parameter> all = {{"/contacts/onset_sigma", settings.contacts.onset_sigma},
                                        {"/contacts/onset_force_n", settings.contacts.onset_force_n},
                                        {"/contacts/release_share", settings.contacts.release_share},
                                        {"/tare", all_tared},
                                        {"/drift/track", settings.drift.track},
                                        {"/stream/rate_hz", broadcaster_.rate_hz()},
                                        {"/recording", recorder_.recording()},
                                        {"/recording/file", recorder_.path()},
                                        {"/tare/log", tare_log_.text()}};
  for (std::size_t k = 0; k < tared_.size(); ++k) {
    all.push_back({"/" + suit_.arrays[k].name + "/tare", tared_[k].load()});
  }
  return all;
}

Status LiveParameters::set(const stream::Parameter& parameter) {
  if (const auto* number = std::get_if<double>(&parameter.value)) return set_number(parameter.name, *number);
  if (const auto* on = std::get_if<bool>(&parameter.value)) return set_switch(parameter.name, *on);
  return bad_input(parameter.name + ": takes a number or true and false");
}

std::string LiveParameters::log_tare(const stream::Parameter& tare, const std::string& who) {
  const std::string array = tare.name == kTare ? "the suit" : tare.name.substr(1, tare.name.size() - 1 - kTare.size());
  const auto* on = std::get_if<bool>(&tare.value);
  return tare_log_.add(suit_.arrays.size() == 1 ? suit_.arrays.front().name : array, on != nullptr && *on, who,
                       std::chrono::system_clock::now());
}

Status LiveParameters::set_number(const std::string& name, double value) {
  if (name == "/stream/rate_hz") {
    if (!(value >= kSlowestStreamHz && value <= kFastestStreamHz)) return bad_input(name + ": must be 1 to 1000");
    broadcaster_.set_rate_hz(value);
    return Done{};
  }
  live::LiveSettings settings = live_.settings();
  if (name == "/contacts/onset_sigma") {
    settings.contacts.onset_sigma = value;
  } else if (name == "/contacts/onset_force_n") {
    settings.contacts.onset_force_n = value;
  } else if (name == "/contacts/release_share") {
    settings.contacts.release_share = value;
  } else {
    return bad_input(name + ": there is no such parameter that takes a number");
  }
  if (Status valid = settings.validate(); !valid) return valid;
  live_.set_settings(settings);
  return Done{};
}

Status LiveParameters::set_switch(const std::string& name, bool value) {
  if (name == "/recording") return switch_recording(value);
  if (name != "/drift/track") return set_tare(name, value);
  live::LiveSettings settings = live_.settings();
  settings.drift.track = value;
  live_.set_settings(settings);
  return Done{};
}

Status LiveParameters::set_tare(const std::string& name, bool value) {
  bool found = false;
  for (std::size_t k = 0; k < tared_.size(); ++k) {
    if (name != kTare && name != "/" + suit_.arrays[k].name + "/tare") continue;
    value ? live_.tare(k) : live_.reset_tare(k);
    tared_[k] = value;
    found = true;
  }
  if (!found) return bad_input(name + ": there is no such parameter that is true or false");
  return Done{};
}

Status LiveParameters::switch_recording(bool on) {
  if (!on) recorder_.stop();
  if (!on || recorder_.recording()) return Done{};
  return recorder_.begin();
}

}  // namespace dermis::serve
