// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::layouts {

/// A field as its name says.
struct NamedField {
  Role role = Role::values;
  std::size_t array = 0;
  double unit = 1.0;
};

enum class FieldsOf { line, packet };

/// "row", "time_ms", ..., or an array by its name. "values" and "value" are the readings of the only array, or of the
/// one that a field `array` names. Fails with the nearest name.
[[nodiscard]] Result<NamedField> field_named(std::string_view name, FieldsOf where,
                                             const std::vector<LayoutArray>& arrays);

}  // namespace dermis::bytes::layouts
