// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/line_pattern.hpp"

#include <algorithm>

#include "bytes/layouts/field_names.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::size_t kLongestPattern = 4096;

bool is_counted(Role role) {
  return role == Role::row || role == Role::col || role == Role::first;
}

bool may_be_hexadecimal(Role role) {
  return is_counted(role) || role == Role::frame || role == Role::flags || role == Role::time;
}

/// " x9" readings, ":x" hexadecimal, ":2x" two digits of it, "-1" where the first row has that number.
Status read_option(std::string_view option, TextField& field) {
  const std::string_view rest = option.substr(1);
  if (option.starts_with(" x") && field.role == Role::values) {
    if (files::parse_number(option.substr(2), field.count) && field.count > 0) return Done{};
  } else if (option.starts_with(":") && rest.ends_with("x") && may_be_hexadecimal(field.role)) {
    field.is_hexadecimal = true;
    const std::string_view width = rest.substr(0, rest.size() - 1);
    if (width.empty() || (files::parse_number(width, field.width) && field.width > 0 && field.width <= 16))
      return Done{};
  } else if (option.starts_with("-") && is_counted(field.role)) {
    const bool is_marked = rest.starts_with("0x");
    if (is_marked ? files::parse_hexadecimal(rest.substr(2), field.from) : files::parse_number(rest, field.from))
      return Done{};
  }
  return bad_input("'" + std::string(option) + "' is no option of it: {values x9}, {row:x}, {row:2x}, {row-1}");
}

/// "row", or "row-1" where rows are counted from 1 on.
Result<TextField> field_in(std::string_view name, const std::vector<LayoutArray>& arrays) {
  const Result<NamedField> whole = field_named(name, FieldsOf::line, arrays);
  if (whole) return TextField{.role = whole->role, .array = whole->array, .unit = whole->unit};
  std::size_t end = std::min(name.find_first_of(" :-"), name.size());
  const Result<NamedField> known = field_named(name.substr(0, end), FieldsOf::line, arrays);
  if (!known) return end < name.size() ? known.error() : whole.error();
  TextField field{.role = known->role, .array = known->array, .unit = known->unit};
  while (end < name.size()) {
    const std::size_t next = std::min(name.find_first_of(" :-", end + 1), name.size());
    if (Status read = read_option(name.substr(end, next - end), field); !read) return read.error();
    end = next;
  }
  return field;
}

Status check_order(const std::vector<TextField>& fields) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const bool is_followed_by_field = k + 1 < fields.size() && fields[k + 1].role != Role::literal;
    if (fields[k].role != Role::literal && fields[k].width == 0 && is_followed_by_field) {
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
