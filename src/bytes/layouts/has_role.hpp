// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// Whether one of the fields of a line or packet has that role.
template <typename Field>
[[nodiscard]] bool has_role(const std::vector<Field>& fields, Role role) {
  return std::any_of(fields.begin(), fields.end(), [&](const Field& field) { return field.role == role; });
}

/// How many of the fields of a line or packet hold readings of that array. Each has an equal share.
template <typename Field>
[[nodiscard]] std::size_t shares_of(const std::vector<Field>& fields, std::size_t array) {
  return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), [&](const Field& field) {
    return field.role == Role::values && field.array == array;
  }));
}

/// The same of several lines or packets.
template <typename Field>
[[nodiscard]] bool has_role(const std::vector<std::vector<Field>>& all, Role role) {
  return std::any_of(all.begin(), all.end(), [&](const std::vector<Field>& fields) { return has_role(fields, role); });
}

/// Whether one of the fields of a line or packet, or of several, is a time.
template <typename Fields>
[[nodiscard]] bool has_time(const Fields& fields) {
  return has_role(fields, Role::time) || has_role(fields, Role::clock) || has_role(fields, Role::datetime);
}

}  // namespace dermis::bytes::layouts
