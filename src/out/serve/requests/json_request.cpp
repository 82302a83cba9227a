// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/requests/json_request.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace dermis::out::serve {
namespace {

using nlohmann::json;

/// Names become fields of CSV files.
bool is_plain(char c) {
  return static_cast<unsigned char>(c) >= ' ' && c != ',' && c != '"' && c != '\x7f';
}

}  // namespace

JsonRequest::JsonRequest(json object) : object_(std::move(object)) {}

Result<JsonRequest> JsonRequest::parse(std::string_view text, std::size_t most_bytes) {
  json parsed = text.size() <= most_bytes ? json::parse(text, nullptr, false) : json();
  if (!parsed.is_object()) {
    return bad_input("the request is no JSON object of at most " + std::to_string(most_bytes / 1024) + " KiB");
  }
  return JsonRequest(std::move(parsed));
}

Result<std::string> JsonRequest::text(const char* field, std::size_t most_bytes) const {
  const auto found = object_.find(field);
  if (found == object_.end()) return std::string();
  if (!found->is_string()) return bad_field(field, "must be a text");
  std::string text = found->get<std::string>();
  if (text.size() > most_bytes || !std::ranges::all_of(text, is_plain)) {
    return bad_field(field, "must have at most " + std::to_string(most_bytes) + " bytes, without commas and quotes");
  }
  return text;
}

Result<std::string> JsonRequest::file_name(const char* field) const {
  Result<std::string> name = text(field);
  if (!name) return name;
  const auto is_plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
  if (name->empty() || !std::ranges::all_of(*name, is_plain)) {
    return bad_field(field, "must be letters, digits, '_' and '-'");
  }
  return name;
}

Result<std::optional<std::uint64_t>> JsonRequest::number(const char* field, const char* wanted) const {
  const auto found = object_.find(field);
  if (found == object_.end()) return std::optional<std::uint64_t>();
  if (!found->is_number_unsigned()) return bad_field(field, std::string("must be ") + wanted);
  return std::optional(found->get<std::uint64_t>());
}

Result<bool> JsonRequest::flag(const char* field) const {
  const auto found = object_.find(field);
  if (found == object_.end()) return false;
  if (!found->is_boolean()) return bad_field(field, "must be true or false");
  return found->get<bool>();
}

Result<std::vector<std::string>> JsonRequest::texts(const char* field) const {
  const auto found = object_.find(field);
  if (found == object_.end() || !found->is_array()) return bad_field(field, "must be a list of texts");
  std::vector<std::string> texts;
  for (const json& value : *found) {
    if (!value.is_string()) return bad_field(field, "must be a list of texts");
    texts.push_back(value.get<std::string>());
  }
  return texts;
}

Result<std::vector<double>> JsonRequest::numbers(const char* field) const {
  const auto found = object_.find(field);
  if (found == object_.end() || !found->is_array()) return bad_field(field, "must be a list of numbers");
  std::vector<double> numbers;
  for (const json& value : *found) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) return bad_field(field, "must be a list of numbers");
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

Result<std::vector<double>> JsonRequest::numbers_or_null(const char* field, std::size_t count) const {
  const auto found = object_.find(field);
  if (found == object_.end() || !found->is_array() || found->size() != count) {
    return bad_field(field, "must be a list of " + std::to_string(count) + ", as the examples had; null: missing");
  }
  std::vector<double> numbers;
  for (const json& value : *found) {
    if (!value.is_number() && !value.is_null())
      return bad_field(field, "must be numbers, or null where one is missing");
    numbers.push_back(value.is_null() ? std::nan("") : value.get<double>());
  }
  return numbers;
}

}  // namespace dermis::out::serve
