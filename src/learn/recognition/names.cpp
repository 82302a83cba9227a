// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/names.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "dermis/bytes/files/text.hpp"

namespace dermis::learn::recognition {
namespace {

using Json = nlohmann::json;

bool is_control(char c) {
  constexpr char kDelete = 0x7F;
  return static_cast<unsigned char>(c) < ' ' || c == kDelete;
}

/// Whether JSON gives it back unchanged.
bool is_utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore)) == Json(text);
}

}  // namespace

bool is_plain_text(const std::string& text) {
  return std::none_of(text.begin(), text.end(), is_control) && is_utf8(text);
}

Status check_class_name(const std::string& name) {
  if (!is_plain_text(name)) {
    return bad_input("class " + bytes::files::in_quotes(name) + " must be UTF-8 without control characters");
  }
  if (name != "unknown") return Done{};
  return bad_input("class 'unknown' is the answer for what is like no class; give it another name");
}

}  // namespace dermis::learn::recognition
