// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/live_settings.hpp"

#include <memory>

#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {

std::vector<LiveParameter> LiveSettingsPart::parameters() {
  const auto set_track = [this](bool track, const std::string&) {
    return change([track](live::suits::LiveSettings& settings) { settings.drift.track = track; });
  };
  return {contact_option("/contacts/onset_sigma", &touch::contacts::ContactOptions::onset_sigma),
          contact_option("/contacts/onset_force_n", &touch::contacts::ContactOptions::onset_force_n),
          contact_option("/contacts/release_share", &touch::contacts::ContactOptions::release_share),
          {.name = "/drift/track", .value = [this] { return live_.settings().drift.track; }, .set_switch = set_track}};
}

LiveParameter LiveSettingsPart::contact_option(const std::string& name,
                                               double touch::contacts::ContactOptions::*option) {
  return {.name = name,
          .value = [this, option] { return live_.settings().contacts.*option; },
          .set_number =
              [this, option](double value) {
                return change([=](live::suits::LiveSettings& settings) { settings.contacts.*option = value; });
              }};
}

Status LiveSettingsPart::change(const std::function<void(live::suits::LiveSettings&)>& change) {
  live::suits::LiveSettings settings = live_.settings();
  change(settings);
  if (Status valid = settings.validate(); !valid) return valid;
  live_.set_settings(settings);
  return Done{};
}

Result<std::unique_ptr<Part>> make_live_settings(Host& host) {
  return std::unique_ptr<Part>(std::make_unique<LiveSettingsPart>(host.live));
}

}  // namespace dermis::out::serve
