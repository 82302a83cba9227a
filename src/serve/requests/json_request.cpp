// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/requests/json_request.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace dermis::serve {
namespace {

using nlohmann::json;

/// Names become fields of CSV files.
bool is_plain(char c) {
  return static_cast<unsigned char>(c) >= ' ' && c != ',' && c != '"' && c != '\x7f';
}

}  // namespace

JsonRequest::JsonRequest(json object) : object_(std::move(object)) {}

Result<JsonRequest> JsonRequest::parse(std::string_view text) {
  json parsed = text.size() <= kMostBytes ? json::parse(text, nullptr, false) : json();
  if (!parsed.is_object()) return bad_input("the request is no JSON object of at most 4 KiB");
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

}  // namespace dermis::serve
