// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "serve/serve_session.hpp"

namespace dermis::app {
namespace {

constexpr double kSlowestStreamHz = 1.0;
constexpr double kFastestStreamHz = 1000.0;

}  // namespace

std::vector<stream::Parameter> ServeSession::parameters() const {
  const fusion::ContactOptions contacts = live_->contact_options();
  const bool all_tared = std::all_of(tared_.begin(), tared_.end(), [](const auto& tared) { return tared.load(); });
  std::vector<stream::Parameter> all = {{"/contacts/onset_sigma", contacts.onset_sigma},
                                        {"/contacts/onset_force_n", contacts.onset_force_n},
                                        {"/contacts/release_share", contacts.release_share},
                                        {"/tare", all_tared},
                                        {"/drift/track", live_->track_drift()},
                                        {"/stream/rate_hz", broadcaster_ ? broadcaster_->rate_hz() : 0.0},
                                        {"/recording", recorder_.recording()},
                                        {"/recording/file", recorder_.path()}};
  for (std::size_t k = 0; k < tared_.size(); ++k) {
    all.push_back({"/" + suit_.arrays[k].name + "/tare", tared_[k].load()});
  }
  return all;
}

Status ServeSession::set_parameter(const stream::Parameter& parameter) {
  if (const auto* number = std::get_if<double>(&parameter.value)) return set_number(parameter.name, *number);
  if (const auto* on = std::get_if<bool>(&parameter.value)) {
    Status set = set_switch(parameter.name, *on);
    if (set) server_->parameters_changed();  // others with it: the file of a recording, the tare of each array
    return set;
  }
  return bad_input(parameter.name + ": takes a number or true and false");
}

Status ServeSession::set_number(const std::string& name, double value) {
  if (name == "/stream/rate_hz") {
    if (!(value >= kSlowestStreamHz && value <= kFastestStreamHz)) return bad_input(name + ": must be 1 to 1000");
    broadcaster_->set_rate_hz(value);
    return Done{};
  }
  fusion::ContactOptions contacts = live_->contact_options();
  if (name == "/contacts/onset_sigma") {
    contacts.onset_sigma = value;
  } else if (name == "/contacts/onset_force_n") {
    contacts.onset_force_n = value;
  } else if (name == "/contacts/release_share") {
    contacts.release_share = value;
  } else {
    return bad_input(name + ": there is no such parameter that takes a number");
  }
  if (Status valid = contacts.validate(); !valid) return valid;
  live_->set_contact_options(contacts);
  return Done{};
}

Status ServeSession::set_switch(const std::string& name, bool value) {
  if (name == "/recording") return switch_recording(value);
  if (name != "/drift/track") return set_tare(name, value);
  live_->set_track_drift(value);
  return Done{};
}

Status ServeSession::set_tare(const std::string& name, bool value) {
  bool found = false;
  for (std::size_t k = 0; k < tared_.size(); ++k) {
    if (name != "/tare" && name != "/" + suit_.arrays[k].name + "/tare") continue;
    value ? live_->tare(k) : live_->reset_tare(k);
    tared_[k] = value;
    found = true;
  }
  if (!found) return bad_input(name + ": there is no such parameter that is true or false");
  return Done{};
}

Status ServeSession::switch_recording(bool on) {
  if (!on) recorder_.stop();
  if (!on || recorder_.recording()) return Done{};
  return recorder_.begin(next_recording(), recorded_arrays());
}

/// The name that was asked for, then the same with the time; nothing is overwritten.
std::string ServeSession::next_recording() const {
  if (!record_.empty() && recorder_.path().empty()) return record_;
  const std::filesystem::path pattern(record_.empty() ? "dermis.mcap" : record_);
  const auto now = std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto milliseconds = now.time_since_epoch().count() % 1000;
  const std::string stamp =
      fmt::format("{:%Y%m%d-%H%M%S}-{:03}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds);
  const std::string name = pattern.stem().string() + "-" + stamp + pattern.extension().string();
  return (pattern.parent_path() / name).string();
}

}  // namespace dermis::app
