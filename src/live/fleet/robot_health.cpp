// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/robot_health.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/one_line.hpp"
#include "live/fleet/health_json.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
constexpr std::size_t kMostArrays = 1000;
constexpr std::size_t kMostTextBytes = 200;
constexpr std::array<const char*, 4> kLevels = {"good", "warning", "error", "ended"};

/// The characters U+202A to U+202E and U+2066 to U+2069 turn the direction of all text behind them.
bool turns_text(std::string_view bytes) {
  const auto last = static_cast<unsigned char>(bytes[2]);
  const bool is_embedding = bytes.starts_with("\xE2\x80") && last >= 0xAAU && last <= 0xAEU;
  return is_embedding || (bytes.starts_with("\xE2\x81") && last >= 0xA6U && last <= 0xA9U);
}

std::string without_turns(std::string text) {
  for (std::size_t k = 0; k + 3 <= text.size(); ++k) {
    if (turns_text(std::string_view(text).substr(k, 3))) text.replace(k, 3, "?");
  }
  return text;
}

/// Cut where a character begins.
std::string shown_text_at(const Json& json, const char* key) {
  std::string text = text_at(json, key);
  std::size_t end = std::min(text.size(), kMostTextBytes);
  const auto is_inside_character = [&] { return (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U; };
  while (end > 0 && end < text.size() && is_inside_character()) --end;
  text.resize(end);
  return one_line(without_turns(std::move(text)));
}

/// An address of HTTP that has neither user nor query; otherwise empty.
std::string web_address_at(const Json& json, const char* key) {
  std::string text = text_at(json, key);
  const bool is_web = text.starts_with("http://") || text.starts_with("https://");
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(".:/-_[]").find(c) != std::string_view::npos;
  };
  const bool is_good = is_web && text.size() <= kMostTextBytes && std::all_of(text.begin(), text.end(), is_plain);
  return is_good ? text : std::string();
}

/// 0 where there is no finite number, or one below 0.
double size_at(const Json& json, const char* key) {
  if (!json.contains(key) || !json[key].is_number()) return 0.0;
  const auto value = json[key].get<double>();
  return std::isfinite(value) && value > 0.0 ? value : 0.0;
}

ArrayHealth::Level level_of(const std::string& name) {
  const auto* const found = std::find(kLevels.begin(), kLevels.end(), name);
  return found == kLevels.end() ? ArrayHealth::Level::error
                                : static_cast<ArrayHealth::Level>(std::distance(kLevels.begin(), found));
}

Nanos time_at(const Json& json, const char* key) {
  constexpr auto kLatest = static_cast<std::uint64_t>(Nanos::max().count());
  return Nanos(static_cast<std::int64_t>(std::min(number_at(json, key), kLatest)));
}

bool flag_at(const Json& json, const char* key) {
  return json.contains(key) && json[key] == true;
}

ArrayHealth array_of(const Json& json) {
  ArrayHealth array;
  array.name = shown_text_at(json, "name");
  array.shape = {number_at(json, "rows"), number_at(json, "cols")};
  array.model = shown_text_at(json, "model");
  array.level = level_of(text_at(json, "level"));
  array.message = shown_text_at(json, "message");
  array.rate_hz = size_at(json, "rate_hz");
  array.lost = number_at(json, "lost");
  array.left_out = number_at(json, "left_out");
  array.masked_taxels = number_at(json, "masked_taxels");
  if (json.contains("gain_change") && json["gain_change"].is_number()) {
    array.gain_change = size_at(json, "gain_change");
  }
  array.wants_calibration = flag_at(json, "wants_calibration");
  array.since = time_at(json, "since_ns");
  array.damaged = number_at(json, "damaged");
  array.late = number_at(json, "late");
  array.wanted_model = number_at(json, "wanted_model");
  array.used_model = number_at(json, "used_model");
  array.refusal = shown_text_at(json, "refusal");
  array.refused = time_at(json, "refused_ns");
  return array;
}

}  // namespace

Json arrays_to_json(const std::vector<ArrayHealth>& arrays) {
  Json list = Json::array();
  for (const ArrayHealth& array : arrays) {
    Json& json = list.emplace_back();
    json = {{"name", array.name},
            {"rows", array.shape.rows},
            {"cols", array.shape.cols},
            {"model", array.model},
            {"level", kLevels[static_cast<std::size_t>(array.level)]},
            {"message", array.message},
            {"rate_hz", array.rate_hz},
            {"lost", array.lost},
            {"left_out", array.left_out},
            {"masked_taxels", array.masked_taxels},
            {"wants_calibration", array.wants_calibration},
            {"since_ns", array.since.count()},
            {"damaged", array.damaged},
            {"late", array.late},
            {"wanted_model", array.wanted_model},
            {"used_model", array.used_model},
            {"refusal", array.refusal},
            {"refused_ns", array.refused.count()}};
    if (array.gain_change) json["gain_change"] = *array.gain_change;
  }
  return list;
}

std::string health_to_json(const RobotHealth& health) {
  Json json = {{"time_ns", health.time.count()},
               {"begun_ns", health.begun.count()},
               {"before_ns", health.before.count()},
               {"is_doubled", health.is_doubled},
               {"live", health.live},
               {"arrays", arrays_to_json(health.arrays)}};
  if (health.free_bytes) json["free_bytes"] = *health.free_bytes;
  return json_text(json);
}

Result<RobotHealth> health_from_json(std::string_view text) {
  if (text.size() > kMostBytes) return bad_input("health: is too large");
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("arrays") || !json["arrays"].is_array()) {
    return bad_input("health: is no JSON with a list \"arrays\"");
  }
  if (json["arrays"].size() > kMostArrays) return bad_input("health: tells of more than 1000 arrays");
  RobotHealth health;
  health.time = time_at(json, "time_ns");
  health.begun = time_at(json, "begun_ns");
  health.before = time_at(json, "before_ns");
  health.is_doubled = flag_at(json, "is_doubled");
  if (json.contains("free_bytes")) health.free_bytes = number_at(json, "free_bytes");
  health.live = web_address_at(json, "live");
  for (const Json& array : json["arrays"]) {
    if (!array.is_object()) return bad_input("health: an array is no object");
    health.arrays.push_back(array_of(array));
  }
  return health;
}

}  // namespace dermis::live::fleet
