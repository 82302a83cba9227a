// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/parts/live_parameters.hpp"

#include <algorithm>
#include <iterator>

namespace dermis::serve {
namespace {

constexpr double kSlowestStreamHz = 1.0;
constexpr double kFastestStreamHz = 1000.0;

}  // namespace

LiveParameters::LiveParameters(const ServedSuit& suit, live::LiveSuit& live, Broadcaster& broadcaster,
                               SuitRecorder& recorder)
    : live_(live), broadcaster_(broadcaster), recorder_(recorder), tares_(suit, live) {}

std::vector<stream::Parameter> LiveParameters::all() const {
  const live::LiveSettings settings = live_.settings();
  std::vector<stream::Parameter> all = {{"/contacts/onset_sigma", settings.contacts.onset_sigma},
                                        {"/contacts/onset_force_n", settings.contacts.onset_force_n},
                                        {"/contacts/release_share", settings.contacts.release_share},
                                        {"/drift/track", settings.drift.track},
                                        {"/stream/rate_hz", broadcaster_.rate_hz()},
                                        {"/recording", recorder_.recording()},
                                        {"/recording/file", recorder_.path()}};
  std::ranges::move(tares_.parameters(), std::back_inserter(all));
  return all;
}

Status LiveParameters::set(const stream::Parameter& parameter, const std::string& client) {
  if (const auto* number = std::get_if<double>(&parameter.value)) return set_number(parameter.name, *number);
  if (const auto* on = std::get_if<bool>(&parameter.value)) return set_switch(parameter.name, *on, client);
  return bad_input(parameter.name + ": takes a number or true and false");
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

Status LiveParameters::set_switch(const std::string& name, bool value, const std::string& client) {
  if (name == "/recording") return switch_recording(value);
  if (tares_.set(name, value, client)) return Done{};
  if (name != "/drift/track") return bad_input(name + ": there is no such parameter that is true or false");
  live::LiveSettings settings = live_.settings();
  settings.drift.track = value;
  live_.set_settings(settings);
  return Done{};
}

Status LiveParameters::switch_recording(bool on) {
  if (!on) recorder_.stop();
  if (!on || recorder_.recording()) return Done{};
  return recorder_.begin();
}

}  // namespace dermis::serve
