// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/line_pattern.hpp"

#include "bytes/layouts/field_names.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::size_t kLongestPattern = 4096;

/// "row", or "row-1" where rows are counted from 1 on.
Result<TextField> field_in(std::string_view name, const std::vector<LayoutArray>& arrays) {
  const Result<NamedField> field = field_named(name, FieldsOf::line, arrays);
  if (field) return TextField{.role = field->role, .array = field->array, .unit = field->unit};
  for (const Role role : {Role::row, Role::col, Role::first}) {
    const bool is_it = name == (role == Role::row ? "row-1" : role == Role::col ? "col-1" : "first-1");
    if (is_it) return TextField{.role = role, .from = 1};
  }
  return field.error();
}

Status check_order(const std::vector<TextField>& fields) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const bool is_followed_by_field = k + 1 < fields.size() && fields[k + 1].role != Role::literal;
    if (fields[k].role != Role::literal && is_followed_by_field) {
      return bad_input("two fields need something between them, such as a comma");
    }
  }
  return Done{};
}

}  // namespace

Result<TextLayout::Pattern> parse_line_pattern(std::string_view pattern, const std::vector<LayoutArray>& arrays) {
  if (pattern.size() > kLongestPattern) return bad_input("has more than 4096 characters");
  std::vector<TextField> fields;
  const auto add_text = [&](char c) {
    if (fields.empty() || fields.back().role != Role::literal) fields.emplace_back();
    fields.back().literal += c;
  };
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    const bool is_doubled = at + 1 < pattern.size() && pattern[at + 1] == pattern[at];
    if (pattern[at] == '{' && !is_doubled) {
      const std::size_t end = pattern.find('}', at);
      if (end == std::string_view::npos) return bad_input("'{' has no '}'");
      const Result<TextField> field = field_in(pattern.substr(at + 1, end - at - 1), arrays);
      if (!field) return field.error();
      fields.push_back(*field);
      at = end;
      continue;
    }
    if ((pattern[at] == '{' || pattern[at] == '}') && is_doubled) ++at;
    add_text(pattern[at]);
  }
  if (Status ordered = check_order(fields); !ordered) return ordered.error();
  return fields;
}

}  // namespace dermis::bytes::layouts
