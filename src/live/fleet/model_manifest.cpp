// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/model_manifest.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <utility>

#include "dermis/live/fleet/stream_address.hpp"
#include "live/fleet/json_values.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::size_t kMostCharacters = 65536;
constexpr std::size_t kMostOfAName = 255;
constexpr std::size_t kSha256Digits = 64;
constexpr std::uint64_t kLargestNumber = std::numeric_limits<std::int64_t>::max();

bool is_sha256(const std::string& text) {
  return text.size() == kSha256Digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

bool is_one_line(const std::string& text) {
  return text.size() <= kMostOfAName &&
         std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; });
}

Result<PushedModel> model_of(const Json& json) {
  const std::uint64_t time = number_at(json, "time");
  PushedModel model{.number = number_at(json, "number"),
                    .name = text_at(json, "name"),
                    .sha256 = text_at(json, "sha256"),
                    .bytes = number_at(json, "bytes"),
                    .pieces = number_at(json, "pieces"),
                    .time = Nanos(static_cast<std::int64_t>(std::min(time, kLargestNumber)))};
  if (model.number == 0 || model.number >= kLargestNumber) return bad_input("a model's number is none");
  if (!is_one_line(model.name)) return bad_input("a model's name must be one line of at most 255 characters");
  if (!is_sha256(model.sha256)) return bad_input("a model's sha256 must be 64 hexadecimal digits");
  if (model.bytes == 0 || model.bytes > ModelManifest::kMostBytes) return bad_input("a model has at most 256 MiB");
  if (model.pieces == 0 || model.pieces > ModelManifest::kMostPieces) {
    return bad_input("a model has at most 4096 pieces");
  }
  return model;
}

auto place_of_current(const ModelManifest& manifest) {
  return std::find_if(manifest.models.begin(), manifest.models.end(),
                      [&](const PushedModel& model) { return model.number == manifest.current; });
}

Status read_models(const Json& models, ModelManifest& manifest) {
  if (models.empty() || models.size() > ModelManifest::kMostModels) return bad_input("has 1 to 10 models");
  for (const Json& json : models) {
    Result<PushedModel> model = model_of(json);
    if (!model) return model.error();
    if (!manifest.models.empty() && manifest.models.back().number >= model->number) {
      return bad_input("the numbers of its models do not rise");
    }
    manifest.models.push_back(*std::move(model));
  }
  return Done{};
}

Result<ModelManifest> parse(std::string_view text) {
  if (text.size() > kMostCharacters) return bad_input("is too long");
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("models") || !json["models"].is_array()) return bad_input("is none");
  ModelManifest manifest{
      .robot = text_at(json, "robot"), .array = text_at(json, "array"), .current = number_at(json, "current")};
  if (const Status good = check_name("robot", manifest.robot); !good) return good.error();
  if (const Status good = check_name("array", manifest.array); !good) return good.error();
  if (const Status read = read_models(json["models"], manifest); !read) return read.error();
  if (place_of_current(manifest) == manifest.models.end()) return bad_input("the current model is none of its models");
  return manifest;
}

}  // namespace

const PushedModel& ModelManifest::current_model() const {
  const auto place = place_of_current(*this);
  assert(place != models.end());
  return *place;
}

void ModelManifest::add(PushedModel model) {
  model.number = models.empty() ? 1 : models.back().number + 1;
  current = model.number;
  models.push_back(std::move(model));
  if (models.size() > kMostModels) models.erase(models.begin());
}

Status ModelManifest::roll_back() {
  const auto place = place_of_current(*this);
  if (place == models.begin()) return bad_input(robot + "/" + array + ": has no model before the current one");
  current = std::prev(place)->number;
  return Done{};
}

std::string manifest_to_json(const ModelManifest& manifest) {
  Json models = Json::array();
  for (const PushedModel& model : manifest.models) {
    models.push_back({{"number", model.number},
                      {"name", model.name},
                      {"sha256", model.sha256},
                      {"bytes", model.bytes},
                      {"pieces", model.pieces},
                      {"time", static_cast<std::uint64_t>(std::max<std::int64_t>(model.time.count(), 0))}});
  }
  return Json({{"robot", manifest.robot},
               {"array", manifest.array},
               {"current", manifest.current},
               {"models", std::move(models)}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<ModelManifest> manifest_from_json(std::string_view text) {
  Result<ModelManifest> manifest = parse(text);
  if (!manifest) return bad_input("a list of pushed models: " + manifest.error().message);
  return manifest;
}

}  // namespace dermis::live::fleet
