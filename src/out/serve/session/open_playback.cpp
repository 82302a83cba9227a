// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/session/open_playback.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/sources/recorded_order.hpp"
#include "out/serve/session/topic_name.hpp"

namespace dermis::out::serve {
namespace {

/// The array is served by the model with which it was recorded.
bool has_recorded_model(const ServedArray& array, const bytes::recordings::RecordedArray& recorded) {
  if (recorded.model_hash.empty()) return false;
  if (array.model_path.empty()) return !recorded.model_file.empty();
  const Result<std::string> hash = bytes::files::content_hash(array.model_path);
  return hash && *hash == recorded.model_hash;
}

/// So that all is as it was when it was recorded. Without one that fits, the present model stays.
void use_recorded_model(const live::suits::Playback& playback, ServedArray& array) {
  const auto& recorded = playback.arrays();
  for (std::size_t k = 0; k < recorded.size(); ++k) {
    if (topic_name(recorded[k].name) != array.name && recorded.size() > 1) continue;
    const Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(recorded[k].model_file, array.name);
    if (!model || model->array.taxel_count() != array.model->array.taxel_count()) continue;
    array.model = std::make_shared<const touch::pipeline::Model>(*model);
    array.played = k;
  }
}

}  // namespace

Status open_playback(const std::string& from, ServedSuit& suit) {
  Result<std::unique_ptr<live::suits::Playback>> playback = live::suits::Playback::open(from);
  if (!playback) return playback.error();
  const std::vector<bytes::recordings::RecordedArray>& recorded = (*playback)->arrays();
  for (ServedArray& array : suit.arrays) {
    const auto same = [&](const bytes::recordings::RecordedArray& other) {
      return topic_name(other.name) == array.name;
    };
    auto found = std::find_if(recorded.begin(), recorded.end(), same);
    if (found == recorded.end() && suit.arrays.size() == 1 && recorded.size() == 1) found = recorded.begin();
    if (found == recorded.end()) return bytes::recordings::find_array(recorded, from, array.name).error();
    const FrameShape shape{array.model->array.rows, array.model->array.cols};
    if (found->shape != shape) {
      return bad_input(fmt::format("'{}': array '{}' has {}x{} taxels, its model {}x{}", from, array.name,
                                   found->shape.rows, found->shape.cols, shape.rows, shape.cols));
    }
    Status order = live::sources::check_recorded_order(from, found->array_toml, array.model->array);
    if (!order) return order;
    array.simulation = found->simulation;
    const auto index = static_cast<std::size_t>(found - recorded.begin());
    array.source = (*playback)->source(index);
    if (has_recorded_model(array, *found)) array.played = index;
  }
  suit.playback = *std::move(playback);
  return Done{};
}

Result<ServedSuit> played_suit(const ServedSuit& suit, const std::string& recording) {
  ServedSuit played;
  played.name = suit.name;
  for (const ServedArray& array : suit.arrays) {
    played.arrays.push_back({.name = array.name,
                             .source = nullptr,
                             .model = array.model,
                             .surface = array.surface,
                             .suit_from_array = array.suit_from_array,
                             .description = array.description,
                             .model_path = array.model_path,
                             .classes = array.classes});
  }
  played.classes = suit.classes;
  played.threats = suit.threats;
  if (suit.body) played.body = suit.body->at_rest();
  if (Status opened = open_playback(recording, played); !opened) return opened.error();
  for (ServedArray& array : played.arrays) use_recorded_model(*played.playback, array);
  return played;
}

}  // namespace dermis::out::serve
