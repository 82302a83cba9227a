// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_draft.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "bytes/proposals/column_names.hpp"
#include "bytes/proposals/left_over.hpp"
#include "bytes/proposals/line_writer.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostBytesOfParts = 4096;

layouts::Role role_of(const std::string& field) {
  using layouts::Role;
  if (field.starts_with("time") || field == "clock" || field == "datetime") return Role::time;
  if (field.starts_with("row")) return Role::row;
  if (field.starts_with("col")) return Role::col;
  if (field.starts_with("first")) return Role::first;
  for (const auto& [name, role] : {std::pair{"frame", Role::frame},
                                   {"array", Role::array},
                                   {"temperature", Role::temperature},
                                   {"supply", Role::supply},
                                   {"flags", Role::flags}}) {
    if (field == name) return role;
  }
  return Role::skip;
}

/// A field whose number is written as the readings are.
std::string written(const std::string& field, layouts::Role role, const Numerals& numerals) {
  using layouts::Role;
  const bool is_number = role == Role::frame || role == Role::time || role == Role::row || role == Role::col ||
                         role == Role::first || role == Role::flags;
  return field + (numerals.is_hexadecimal && is_number ? ":x" : "");
}

/// Arrays side by side in one span are as many pieces of it.
std::vector<Place> places_of(const LinesAlike& text, const Draft& draft, const LineFields& fields) {
  const bool are_in_turn = !fields.ids.empty() || !text.group.names.empty();
  std::vector<Place> places;
  std::size_t array = 0;
  for (std::size_t k = 0; k < text.columns.size();) {
    const auto span =
        std::find_if(fields.spans.begin(), fields.spans.end(), [&](const Span& one) { return one.begin == k; });
    if (span == fields.spans.end()) {
      const std::string& field = fields.fields[k++];
      places.push_back({field.empty() ? "skip" : written(field, role_of(field), text.numerals), k, role_of(field)});
      continue;
    }
    if (span->has_labels) {
      for (; k < span->end; ++k)
        places.push_back(
            {span->has(k) ? "value" : "skip", k + 1, span->has(k) ? layouts::Role::values : layouts::Role::skip});
      continue;
    }
    const std::size_t size = span->size();
    const bool is_split = !are_in_turn && fields.spans.size() < draft.arrays.size();
    const std::size_t pieces = is_split ? draft.arrays.size() / fields.spans.size() : 1;
    for (std::size_t piece = 1; piece <= pieces; ++piece, ++array) {
      const bool is_named = !are_in_turn && draft.arrays.size() > 1;
      places.push_back({is_named         ? draft.arrays[array].name
                        : fields.is_part ? "values x" + std::to_string(size)
                        : size == 1      ? "value"
                                         : "values",
                        k + size * piece / pieces});
    }
    k += size;
  }
  return places;
}

}  // namespace

std::string head_of(const LinesAlike& text, const std::vector<std::size_t>& heads) {
  if (heads.empty()) return {};
  const LineGroup group{.members = heads};
  const Line& first = text.lines[heads.front()];
  const auto is_other = [&](std::size_t line) { return text.lines[line].skeleton != first.skeleton; };
  if (std::any_of(heads.begin(), heads.end(), is_other)) return {};
  std::vector<Place> places;
  bool tells = false;
  for (const Column& column : columns_of(text.lines, group, text.numerals, true)) {
    const bool is_told = column.field == "frame" || role_of(column.field) == layouts::Role::time;
    tells = tells || is_told;
    places.push_back({is_told ? written(column.field, role_of(column.field), text.numerals) : "skip", places.size() + 1,
                      role_of(column.field)});
  }
  return tells ? pattern_of(first, places, 0, 0) : std::string();
}

Draft begin_line_draft(const LinesAlike& text, const LineFields& fields, const Known& known) {
  Draft draft;
  draft.merit = fields.merit;
  draft.reasons = fields.reasons;
  draft.doubts = fields.doubts;
  for (const std::string& name : text.group.names) {
    draft.reasons.push_back("lines with '" + name + "' hold readings of an array of that name");
  }
  if (text.numerals.decimal_point == ',') draft.keys.emplace_back("decimal_point", "\",\"");
  if (text.numerals.is_hexadecimal) draft.keys.emplace_back("digits", "\"hexadecimal\"");
  if (text.numerals.width > 0) {
    draft.keys.emplace_back("width", std::to_string(text.numerals.width));
    draft.doubts.push_back("nothing stands between the numbers: that each has " + std::to_string(text.numerals.width) +
                           " digits is what fits best");
  }
  if (!text.numerals.separator.empty())
    draft.keys.emplace_back("separator", files::quoted_toml(text.numerals.separator));
  const std::string unit = unit_of_name(text.columns[fields.spans.front().begin].name);
  if (!unit.empty() && known.unit.empty()) draft.keys.emplace_back("unit", files::quoted_toml(unit));
  draft.has_certain_unit = !unit.empty();
  return draft;
}

void write_line(const LinesAlike& text, const LineFields& fields, Draft& draft) {
  const std::vector<Place> places = places_of(text, draft, fields);
  const std::size_t word = text.group.names.empty() ? 0 : text.group.names.front().size();
  draft.line = pattern_of(text.lines[text.group.members.front()], places, text.group.word_at, word);
  for (const std::size_t member : text.group.members) {
    if (text.lines[member].begin > kMostBytesOfParts) break;
    add_parts(text.lines[member], places, draft.parts);
  }
  std::size_t numbers = 0;
  for (const Span& span : fields.spans) numbers += span.size();
  draft.look = std::to_string(text.group.members.size()) + " lines of " + std::to_string(numbers) +
               (numbers == 1 ? " number" : " numbers");
  draft.left_over = left_over_lines(text.lines, text.group.members);
}

}  // namespace dermis::bytes::proposals
