// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/served_suit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/live/sources/recorded_order.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "out/serve/recognition/live_recognition.hpp"
#include "out/serve/recognition/suit_recognition.hpp"
#include "out/serve/session/open_playback.hpp"
#include "out/serve/session/topic_name.hpp"
#include "out/serve/suit/model_or_array.hpp"

namespace dermis::out::serve {
namespace {

using live::sources::SourceKind;
using live::sources::SourceName;

using Notice = std::function<void(const std::string&)>;

/// Without a model.
Result<ModelOrArray> array_of_source(const std::string& text, const Notice& notice) {
  const Result<SourceName> from = SourceName::parse(text);
  if (!from) return from.error();
  if (Status can = check_served(*from); !can) return can.error();
  if (from->kind == SourceKind::recording) return read_recorded_array(text);
  if (!describes_its_array(*from)) return bad_input("'" + text + "': name its model, too, or its array.toml");
  if (notice) notice(text + ": the simulator loads its array to calibrate it");
  return calibrate_simulated_array(*from->uri);
}

/// Models, read once each.
class Models {
 public:
  struct Known {
    std::shared_ptr<const touch::pipeline::Model> model;
    ArrayDescription description;
  };

  Result<Known> read(const SuitArray& array, const Notice& notice) {
    const bool is_named = !array.model.empty();
    const std::string& place = is_named ? array.model : array.from;
    const auto known = read_.find(place);
    if (known != read_.end()) return known->second;
    Result<ModelOrArray> read = is_named ? read_model_or_array(place) : array_of_source(place, notice);
    if (!read) return read.error();
    Known fresh{std::make_shared<const touch::pipeline::Model>(std::move(read->model)), std::move(read->array)};
    read_[place] = fresh;
    return fresh;
  }

 private:
  std::map<std::string, Known> read_;
};

/// The suit of suit.toml, or one flat array.
Result<SuitDescription> describe(const SuitPlace& place) {
  if (!place.suit.empty()) return bytes::files::read_suit(place.suit);
  SuitArray array;
  array.from = place.from;
  array.model = place.model;
  array.classes = place.classes;
  SuitDescription suit;
  suit.arrays.push_back(std::move(array));
  return suit;
}

/// `create(classes)`: the recognition that they are for.
template <typename Create>
Result<learn::recognition::Classes> read_classes(const std::string& path, const Notice& notice, const Create& create) {
  Result<learn::recognition::Classes> classes = learn::recognition::read_classes(path);
  if (!classes) return classes.error();
  const Result<LiveRecognition> fits = create(*classes);
  if (!fits) return bad_input(fmt::format("{}: {}", path, fits.error().message));
  if (!classes->layout.has_forces() && notice) {
    notice(path + ": was not learned with a model; what it learned from is taken for newtons");
  }
  return classes;
}

Status read_classes_of_array(const std::string& path, const Notice& notice, ServedArray& array) {
  if (path.empty()) return Done{};
  Result<learn::recognition::Classes> classes =
      read_classes(path, notice, [&](const learn::recognition::Classes& read) {
        return LiveRecognition::create(read, {learn::recognition::sensed_array(array.model->array, array.name)});
      });
  if (!classes) return classes.error();
  array.classes = *std::move(classes);
  return Done{};
}

Status read_classes_of_suit(const std::string& path, const Notice& notice, ServedSuit& suit) {
  if (path.empty()) return Done{};
  Result<learn::recognition::Classes> classes = read_classes(
      path, notice, [&](const learn::recognition::Classes& read) { return recognition_of_suit(read, suit.arrays); });
  if (!classes) return classes.error();
  suit.classes = *std::move(classes);
  return Done{};
}

/// Takes the files that suit.toml names; a command warns about those that its user named.
void tell_missing_checksums(const SuitDescription& suit, const Notice& notice) {
  if (!notice) return;
  std::set<std::pair<std::string, const bytes::files::FileFormat*>> named{
      {suit.classes, &learn::recognition::kClassesFormat}};
  for (const SuitArray& array : suit.arrays) {
    named.insert({{array.model, &bytes::models::kModelFormat}, {array.classes, &learn::recognition::kClassesFormat}});
  }
  for (const auto& [path, format] : named) {
    if (const auto note = bytes::files::checksum_note(path, *format)) notice(*note);
  }
}

/// Zones of arrays that are not there may be misspelt.
Status read_threats(const std::string& path, const Notice& notice, ServedSuit& suit) {
  if (path.empty()) return Done{};
  Result<live::threats::ThreatLimits> limits = live::threats::read_threat_limits(path);
  if (!limits) return limits.error();
  for (live::threats::Zone& zone : limits->zones) {
    zone.array = topic_name(zone.array);
    const bool is_there = std::any_of(suit.arrays.begin(), suit.arrays.end(),
                                      [&](const ServedArray& array) { return array.name == zone.array; });
    if (!is_there && notice) {
      notice(fmt::format("{}: zone '{}' is of '{}', which is not served", path, zone.name, zone.array));
    }
  }
  bool any = false;
  for (const ServedArray& array : suit.arrays) {
    const auto monitor = live::threats::ThreatMonitor::create(*limits, array.name, array.model->array);
    if (!monitor) return bad_input(fmt::format("{}: {}", path, monitor.error().message));
    any = any || !monitor->states().empty();
  }
  if (!any) return bad_input(fmt::format("{}: no threat is for what is served; its zones are of other arrays", path));
  suit.threats = *std::move(limits);
  return Done{};
}

/// The place of an array on a body at rest.
struct RestPlace {
  WornBody::Carried carried;
  Pose suit_from_array;
};

/// `rest`: of the links of the body.
Result<RestPlace> place_of(const SuitArray& array, const BodyParts* parts, const std::vector<Pose>& rest) {
  if (parts == nullptr) return RestPlace{{}, array.base_from_array};
  const std::optional<std::size_t> link = array.link.empty() ? std::size_t{0} : parts->body.link(array.link);
  if (!link) {
    return bad_input(
        fmt::format("array '{}': link: the body '{}' has no '{}'", array.name, parts->body.name, array.link));
  }
  return RestPlace{{*link, array.base_from_array}, chained(rest[*link], array.base_from_array)};
}

Result<ServedArray> open_array(const SuitArray& described, const Pose& suit_from_array, const Notice& notice,
                               Models& models) {
  Result<Models::Known> known = models.read(described, notice);
  if (!known) return known.error();
  const ArrayDescription& array = known->model->array;
  std::string name = described.name.empty() ? topic_name(array.name) : described.name;
  Result<ArraySurface> surface = ArraySurface::create(array, described.shape, suit_from_array, described.mirrored);
  if (!surface) return bad_input(fmt::format("array '{}': {}", name, surface.error().message));
  ServedArray served{.name = std::move(name),
                     .source = nullptr,
                     .model = std::move(known->model),
                     .surface = *std::move(surface),
                     .suit_from_array = suit_from_array,
                     .description = std::move(known->description),
                     .model_path = described.model,
                     .places = free_places({array.rows, array.cols}, described.shape)};
  if (Status read = read_classes_of_array(described.classes, notice, served); !read) return read.error();
  return served;
}

/// All arrays, and the body that carries them.
Status open_arrays(const SuitDescription& described, const Notice& notice, std::optional<BodyParts> parts,
                   ServedSuit& suit) {
  Models models;
  std::vector<WornBody::Carried> carried;
  const std::vector<Pose> rest = parts ? rest_poses(parts->body) : std::vector<Pose>();
  for (const SuitArray& one : described.arrays) {
    const Result<RestPlace> place = place_of(one, parts ? &*parts : nullptr, rest);
    if (!place) return place.error();
    Result<ServedArray> array = open_array(one, place->suit_from_array, notice, models);
    if (!array) return array.error();
    suit.arrays.push_back(*std::move(array));
    carried.push_back(place->carried);
  }
  if (parts) {
    suit.body = std::make_shared<WornBody>(std::make_shared<BodyParts>(*std::move(parts)), std::move(carried));
  }
  return Done{};
}

Result<std::unique_ptr<FrameSource>> open_live(const std::string& text, const ServedArray& array,
                                               live::sources::SourceOptions options) {
  const Result<SourceName> from = SourceName::parse(text);
  if (!from) return from.error();
  if (Status can = check_served(*from); !can) return can.error();
  if (from->kind == SourceKind::recording) {
    return bad_input(fmt::format("'{}': is a recording of a suit; name its suit.toml, too", text));
  }
  options.array = &array.model->array;
  return live::sources::open_source(*from, options);
}

/// All at once: a device may take its time to answer, and a scene to be simulated. Returns the first array's error
/// where there are several.
Status open_together(const SuitDescription& described, const live::sources::SourceOptions& options, ServedSuit& suit) {
  using Opened = Result<std::unique_ptr<FrameSource>>;
  const auto how = suit.arrays.size() == 1 ? std::launch::deferred : std::launch::async;
  std::vector<std::future<Opened>> opening;
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    opening.push_back(std::async(how, open_live, described.arrays[k].from, std::cref(suit.arrays[k]), options));
  }
  Status all = Done{};
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    Opened source = opening[k].get();
    if (!source) {
      if (all) all = source.error();
      continue;
    }
    suit.arrays[k].simulation = live::sources::notes_of_source(**source, described.arrays[k].from).simulation;
    suit.arrays[k].source = *std::move(source);
    suit.arrays[k].from = described.arrays[k].from;
  }
  return all;
}

Status open_sources(const SuitPlace& place, const SuitDescription& described,
                    const live::sources::SourceOptions& options, ServedSuit& suit) {
  const Result<SourceName> from = SourceName::parse(place.from);
  if (!from) return from.error();
  if (from->kind == SourceKind::recording) return open_playback(place.from, suit);
  return open_together(described, options, suit);
}

}  // namespace

Status check_served(const SourceName& from) {
  const auto refuse = [&](const std::string& why) { return bad_input(fmt::format("'{}': {}", from.text, why)); };
  if (from.has_times_of_its_own()) {
    return refuse("has times of its own; make a recording of it first");
  }
  if (from.kind == SourceKind::file) {
    return refuse(fmt::format(
        "only devices and recordings are served; make a recording of it first: convert {} to .mcap", from.text));
  }
  if (from.needs_rate()) {
    return refuse(fmt::format("say how many frames a second it sends, such as {}{}rate=100", from.text,
                              from.text.find('?') == std::string::npos ? "?" : "&"));
  }
  return Done{};
}

bool describes_its_array(const SourceName& from) {
  // A rehearsal is one of a calibration, by somebody who has no model.
  if (from.kind == SourceKind::simulation) return from.uri->path != "rehearsal";
  if (from.kind != SourceKind::recording) return false;
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(from.text);
  return notes && !notes->array_toml.empty();
}

Result<ServedSuit> open_suit(const SuitPlace& place, live::sources::SourceOptions options) {
  const Result<SuitDescription> described = describe(place);
  if (!described) return described.error();
  ServedSuit suit;
  suit.name = described->name;
  std::optional<BodyParts> parts;
  if (!described->body.empty()) {
    Result<BodyParts> read = read_body(described->body, described->body_scale, options.notice);
    if (!read) return read.error();
    parts = *std::move(read);
  }
  if (Status opened = open_arrays(*described, options.notice, std::move(parts), suit); !opened) return opened.error();
  if (Status read = read_classes_of_suit(described->classes, options.notice, suit); !read) return read.error();
  if (Status read = read_threats(place.threats, options.notice, suit); !read) return read.error();
  if (!place.suit.empty()) tell_missing_checksums(*described, options.notice);
  options.guide = suit.guide;
  if (Status opened = open_sources(place, *described, options, suit); !opened) return opened.error();
  return suit;
}

}  // namespace dermis::out::serve
