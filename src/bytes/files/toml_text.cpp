// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/toml_text.hpp"

#include <utility>

namespace dermis::bytes::files {
namespace {

Error is_no_toml(const toml::parse_error& error, const std::string& name) {
  const toml::source_position at = error.source().begin;
  return bad_input(name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                   std::string(error.description()));
}

}  // namespace

#if TOML_EXCEPTIONS
Result<toml::table> parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    return is_no_toml(error, name);
  }
}
#else
Result<toml::table> parse_toml(std::string_view text, const std::string& name) {
  toml::parse_result parsed = toml::parse(text);
  if (!parsed) return is_no_toml(parsed.error(), name);
  return std::move(parsed).table();
}
#endif

}  // namespace dermis::bytes::files
