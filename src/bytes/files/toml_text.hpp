// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Without exceptions, too (the module of a page has none). Errors begin with `name`, the line and the column.
[[nodiscard]] Result<toml::table> parse_toml(std::string_view text, const std::string& name);

}  // namespace dermis::bytes::files
