// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/served_suit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "dermis/acquisition/source_uri.hpp"
#include "dermis/files/suit_toml.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/sources/open_source.hpp"
#include "live_line.hpp"
#include "model_or_array.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

constexpr double kUnknownFullScaleN = 50.0;

/// A name that topics may have, as suit.toml asks for.
std::string topic_name(const std::string& name) {
  std::string topic;
  for (const char letter : name) {
    topic += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  }
  const bool begins_with_letter = !topic.empty() && std::isalpha(static_cast<unsigned char>(topic.front())) != 0;
  return begins_with_letter ? topic : "array_" + topic;
}

/// Models, read once each.
class Models {
 public:
  struct Known {
    std::shared_ptr<const pipeline::Model> model;
    ArrayDescription description;
  };

  Result<Known> read(const std::string& path) {
    const auto known = read_.find(path);
    if (known != read_.end()) return known->second;
    Result<ModelOrArray> read = read_model_or_array(path);
    if (!read) return read.error();
    Known fresh{std::make_shared<const pipeline::Model>(std::move(read->model)), std::move(read->array)};
    read_[path] = fresh;
    return fresh;
  }

 private:
  std::map<std::string, Known> read_;
};

/// As suit.toml tells, or one flat array.
Result<SuitDescription> describe(const SuitPlace& place) {
  if (!place.suit.empty()) return files::read_suit(place.suit);
  SuitArray array;
  array.from = place.from;
  array.model = place.model;
  SuitDescription suit;
  suit.arrays.push_back(std::move(array));
  return suit;
}

Result<ServedArray> open_array(const SuitArray& described, Models& models) {
  Result<Models::Known> known = models.read(described.model);
  if (!known) return known.error();
  const ArrayDescription& array = known->model->array;
  std::string name = described.name.empty() ? topic_name(array.name) : described.name;
  Result<ArraySurface> surface =
      ArraySurface::create(array, described.shape, described.base_from_array, described.mirrored);
  if (!surface) return bad_input(fmt::format("array '{}': {}", name, surface.error().message));
  return ServedArray{std::move(name),         std::move(known->description), described.model,
                     std::move(known->model), *std::move(surface),           described.base_from_array};
}

bool is_recording(const std::string& from) {
  if (acquisition::is_source_uri(from)) return false;
  return from.substr(0, from.find('#')).ends_with(".mcap");
}

Result<std::unique_ptr<FrameSource>> open_live_source(const std::string& from, const ServedArray& array,
                                                      const std::shared_ptr<sources::GuideVoice>& guide) {
  if (is_recording(from)) {
    return bad_input(fmt::format("'{}': a recording is served with --from {} --suit suit.toml", from, from));
  }
  if (!acquisition::is_source_uri(from)) {
    return bad_input(
        fmt::format("'{}': only devices and recordings are served; make a recording of it first "
                    "(dermis convert {} it.mcap)",
                    from, from));
  }
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  if (!uri) return uri.error();
  if (uri->transport == acquisition::Transport::simulation && !uri->rate_hz) {
    return bad_input(fmt::format("'{}': say how many frames a second it sends, such as {}{}rate=100", from, from,
                                 from.find('?') == std::string::npos ? "?" : "&"));
  }
  return sources::open_source(*uri, {&array.model->array, &stop_flag(), say, guide});
}

/// Index in the recording of each array of the suit.
Status open_playback(const std::string& from, ServedSuit& suit) {
  Result<std::unique_ptr<live::Playback>> playback = live::Playback::open(from);
  if (!playback) return playback.error();
  const std::vector<recordings::RecordedArray>& recorded = (*playback)->arrays();
  for (const ServedArray& array : suit.arrays) {
    const auto same = [&](const recordings::RecordedArray& other) { return topic_name(other.name) == array.name; };
    auto found = std::find_if(recorded.begin(), recorded.end(), same);
    if (found == recorded.end() && suit.arrays.size() == 1 && recorded.size() == 1) found = recorded.begin();
    if (found == recorded.end()) return bad_input(fmt::format("'{}': holds no array '{}'", from, array.name));
    const FrameShape shape{array.model->array.rows, array.model->array.cols};
    if (found->shape != shape) {
      return bad_input(fmt::format("'{}': array '{}' has {}x{} taxels, its model {}x{}", from, array.name,
                                   found->shape.rows, found->shape.cols, shape.rows, shape.cols));
    }
    suit.sources.push_back((*playback)->source(static_cast<std::size_t>(found - recorded.begin())));
  }
  suit.playback = *std::move(playback);
  return Done{};
}

Status open_sources(const SuitPlace& place, const SuitDescription& described, ServedSuit& suit) {
  if (is_recording(place.from)) return open_playback(place.from, suit);
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    Result<std::unique_ptr<FrameSource>> source =
        open_live_source(described.arrays[k].from, suit.arrays[k], suit.guide);
    if (!source) return source.error();
    suit.sources.push_back(*std::move(source));
  }
  return Done{};
}

double full_scale_newtons(const fusion::ForceNetworks& networks) {
  double heaviest = 0.0;
  for (std::size_t k = 0; k < networks.taxel_count(); ++k) {
    const auto newtons = static_cast<double>(networks.heaviest_newtons[k]);
    if (networks.dead[k] == 0 && std::isfinite(newtons)) heaviest = std::max(heaviest, newtons);
  }
  return heaviest > 0.0 ? heaviest : kUnknownFullScaleN;
}

nlohmann::ordered_json json_of(const Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

nlohmann::ordered_json json_of(const ServedArray& array) {
  const ArrayDescription& description = array.model->array;
  nlohmann::ordered_json json;
  json["name"] = array.name;
  json["rows"] = description.rows;
  json["cols"] = description.cols;
  json["pitch_m"] = {description.row_pitch_m, description.col_pitch_m};
  json["taxel_area_m2"] = nullptr;
  if (description.taxel_area_m2) json["taxel_area_m2"] = *description.taxel_area_m2;
  json["full_scale_counts"] = description.readout.full_scale_counts();
  json["full_scale_n"] = full_scale_newtons(array.model->networks);
  for (const SurfacePoint& taxel : array.surface.taxels()) {
    json["positions"].push_back(json_of(taxel.position));
    json["normals"].push_back(json_of(taxel.normal));
  }
  return json;
}

}  // namespace

Result<ServedSuit> open_served_suit(const SuitPlace& place) {
  const Result<SuitDescription> described = describe(place);
  if (!described) return described.error();
  ServedSuit suit;
  suit.name = described->name;
  Models models;
  for (const SuitArray& one : described->arrays) {
    Result<ServedArray> array = open_array(one, models);
    if (!array) return array.error();
    suit.arrays.push_back(*std::move(array));
  }
  if (Status opened = open_sources(place, *described, suit); !opened) return opened.error();
  return suit;
}

std::string suit_json(const ServedSuit& suit) {
  nlohmann::ordered_json json;
  json["name"] = suit.name;
  json["arrays"] = nlohmann::ordered_json::array();
  for (const ServedArray& array : suit.arrays) json["arrays"].push_back(json_of(array));
  return json.dump();
}

}  // namespace dermis::app
