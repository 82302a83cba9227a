// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/press_watch.hpp"

#include <fmt/core.h>

#include <optional>
#include <utility>
#include <vector>

#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::out::serve {

using learn::arrangement::Places;

Result<Places> press_places_request(const JsonRequest& request) {
  const Result<std::vector<double>> coordinates = request.numbers("places_mm");
  if (coordinates && !coordinates->empty()) {
    if (coordinates->size() % 2 != 0) return bad_field("places_mm", "must be x and y of each place");
    std::vector<bytes::files::NamedPlace> places(coordinates->size() / 2);
    for (std::size_t k = 0; k < places.size(); ++k) {
      places[k].position = {(*coordinates)[2 * k] / kMillimetresPerMetre,
                            (*coordinates)[2 * k + 1] / kMillimetresPerMetre, 0.0};
    }
    return learn::arrangement::places_of(std::move(places));
  }
  std::vector<std::uint64_t> numbers;
  for (const char* const field : {"rows", "cols", "pitch_um"}) {
    const Result<std::optional<std::uint64_t>> number = request.number(field, "a whole number");
    if (!number) return number.error();
    if (!*number) return bad_field(field, "must be a whole number");
    numbers.push_back(**number);
  }
  return learn::arrangement::read_press_places(fmt::format("{}x{}", numbers[0], numbers[1]),
                                               1e-3 * static_cast<double>(numbers[2]));
}

PressWatch::PressWatch(const live::sources::SourceName& name, FrameShape sent, Places places,
                       live::sources::SourceOptions options)
    : places_(std::move(places)),
      guide_(places_.places.size()),
      watch_(name, sent, std::move(options), [this](const RawFrame& frame) {
        const std::lock_guard lock(mutex_);
        guide_.add(frame.counts, frame.time);
      }) {}

nlohmann::ordered_json PressWatch::progress() {
  const std::string problem = watch_.seen().problem;
  const std::lock_guard lock(mutex_);
  nlohmann::ordered_json json = {{"ready", guide_.is_ready()}, {"place", guide_.place()},
                                 {"done", guide_.is_done()},   {"pressed", guide_.is_pressed()},
                                 {"repeated", nullptr},        {"channels", nlohmann::ordered_json::array()},
                                 {"problem", problem}};
  if (guide_.repeated()) json["repeated"] = *guide_.repeated();
  for (const auto& answer : guide_.answers())
    json["channels"].push_back(answer ? nlohmann::ordered_json(answer->channel) : nlohmann::ordered_json());
  return json;
}

void PressWatch::skip() {
  const std::lock_guard lock(mutex_);
  guide_.skip();
}

void PressWatch::back() {
  const std::lock_guard lock(mutex_);
  guide_.back();
}

Result<learn::arrangement::Arrangement> PressWatch::arrange(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return learn::arrangement::arrange(places_, guide_.answers(), watch_.shape(), guide_.most_counts(), name);
}

}  // namespace dermis::out::serve
