// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/field_names.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::bytes::layouts {
namespace {

struct KnownField {
  const char* name = nullptr;
  Role role = Role::values;
  double unit = 1.0;
  bool is_of_lines = true;
  bool is_of_packets = true;
};

constexpr std::array kFields = {
    KnownField{"values", Role::values},
    KnownField{"value", Role::values},
    KnownField{"skip", Role::skip},
    KnownField{"row", Role::row},
    KnownField{"col", Role::col},
    KnownField{"first", Role::first},
    KnownField{"count", Role::count, 1.0, false},
    KnownField{"array", Role::array},
    KnownField{"frame", Role::frame},
    KnownField{"time_s", Role::time},
    KnownField{"time_ms", Role::time, 1e-3},
    KnownField{"time_us", Role::time, 1e-6},
    KnownField{"time_ns", Role::time, 1e-9},
    KnownField{"clock", Role::clock, 1.0, true, false},
    KnownField{"datetime", Role::datetime, 1.0, true, false},
    KnownField{"temperature", Role::temperature},
    KnownField{"supply", Role::supply},
    KnownField{"flags", Role::flags},
    KnownField{"length", Role::length, 1.0, false},
    KnownField{"checksum", Role::checksum, 1.0, false},
};

}  // namespace

Result<NamedField> field_named(std::string_view name, FieldsOf where, const std::vector<LayoutArray>& arrays) {
  const auto of_name = [&](const LayoutArray& array) { return array.name == name; };
  if (const auto found = std::find_if(arrays.begin(), arrays.end(), of_name); !name.empty() && found != arrays.end()) {
    return NamedField{Role::values, static_cast<std::size_t>(found - arrays.begin()), 1.0};
  }
  std::set<std::string> known;
  for (const KnownField& field : kFields) {
    if (!(where == FieldsOf::line ? field.is_of_lines : field.is_of_packets)) continue;
    if (field.name == name) return NamedField{field.role, 0, field.unit};
    known.insert(field.name);
  }
  for (const LayoutArray& array : arrays) known.insert(array.name);
  known.erase("");
  const std::string nearest = nearest_name(std::string(name), known);
  std::string message = "'" + std::string(name) + "' is no field";
  if (!nearest.empty()) return bad_input(message + "; did you mean '" + nearest + "'?");
  message += "; known are";
  for (const std::string& one : known) message += " " + one;
  return bad_input(message);
}

}  // namespace dermis::bytes::layouts
