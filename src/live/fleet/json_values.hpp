// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

/// Values of JSON that may hold anything: a value that is absent or of another type reads as empty.
namespace dermis::live::fleet {

using Json = nlohmann::json;

[[nodiscard]] inline Json object_at(const Json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_object() ? json[key] : Json::object();
}

[[nodiscard]] inline std::uint64_t number_at(const Json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_number_unsigned() ? json[key].get<std::uint64_t>() : 0;
}

[[nodiscard]] inline std::string text_at(const Json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

}  // namespace dermis::live::fleet
